#include "core/offset/estimate_over_time.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/offset/find_offset.hpp"
#include "core/offset/judgement/evidence.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/over_time/over_time.hpp"
#include "core/offset/walk/walk.hpp"

namespace sweepscope {
namespace {

constexpr double kUnseenOfWalks_s = 0.1e-3;     // common error of all parts of a walk: see mean_of
constexpr double kUnseenOfWalkPart_s = 0.2e-3;  // scatter of the parts beyond their sigmas: see drift_of

// The windows of a walk, and the standard deviation of the error that they have in common.
struct FollowedWalk {
  std::vector<OffsetWindow> windows;
  double common_sigma_s = kUnseenOfWalks_s;
};

// The parts of a walk as windows. Times are seconds since the recording's first scan.
std::vector<OffsetWindow> windows_of_parts(const std::vector<JointWalkPart>& parts,
                                           const RecordingPart& stretch, double begin_s,
                                           const SearchScale& scale) {
  std::vector<OffsetWindow> windows;
  const auto between_s = [&](std::size_t one, std::size_t other) {
    return (parts[one].middle_s + parts[other].middle_s) / 2 - begin_s;
  };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const RecordingPart window{i == 0 ? stretch.begin_s : between_s(i - 1, i),
                               i + 1 == parts.size() ? stretch.end_s : between_s(i, i + 1)};
    if (const auto unsure = sigma_refusal(parts[i].sigma_s, scale))
      windows.push_back(window_without(window, unsure->text));
    else
      windows.push_back({window.begin_s,
                         window.end_s,
                         parts[i].middle_s - begin_s,
                         parts[i].offset_s,
                         std::hypot(parts[i].sigma_s, kUnseenOfWalkPart_s),
                         {}});
  }
  return windows;
}

// The rig moved in a stretch, or it was stationary, or there is no answer.
std::vector<OffsetWindow> windows_of_stretch(const Estimate& found, const RecordingPart& stretch,
                                             double begin_s, const SearchScale& scale) {
  if (!found.identifiable)
    return {window_without(stretch,
                           found.refusals.empty() ? "There is no answer." : found.refusals.front().text)};
  if (found.walk && found.walk->joint)
    return windows_of_parts(found.walk->joint->parts, stretch, begin_s, scale);
  const double middle_s = (stretch.begin_s + stretch.end_s) / 2;
  return {{stretch.begin_s, stretch.end_s, middle_s, found.offset_s, found.sigma_s, {}}};
}

// The scans of a stretch, with the motor's stamps moved back by `gone_s`.
Recording stretch_of(const Recording& recording, const RecordingPart& stretch, double gone_s) {
  Recording part = window(recording, stretch.begin_s, stretch.end_s, 1 + std::abs(gone_s));
  for (double& time_s : part.motor.time_s) time_s -= gone_s;
  return part;
}

Result<FollowedWalk> follow_walk(const Recording& recording, double window_s, const EstimateOptions& options,
                                 const Job& job) {
  // Half a minute has three parts of JointWalkOptions, the fewest whose scatter is known. Offsets that have
  // drifted by more than 10 ms are followed, so that they stay well within the default search.
  constexpr double kStretch_s = 30, kFar_s = 0.010;
  const double begin_s = recording.scans.front().first_beam_s;
  FollowedWalk followed;
  std::optional<double> first_s, last_s;
  for (const RecordingPart& stretch : windows_of(recorded_s(recording), std::max(kStretch_s, window_s))) {
    const double gone_s = first_s && std::abs(*last_s - *first_s) > kFar_s ? *last_s - *first_s : 0;
    const Recording part = stretch_of(recording, stretch, gone_s);
    if (part.scans.size() < kMinScansOfWindow) {
      followed.windows.push_back(window_without(stretch, kNoScans));
      continue;
    }
    const auto found = find_offset(part, {}, options, {}, job);
    if (!found) return tl::unexpected(found.error());
    if (job.cancelled()) return followed;
    if (found->identifiable && found->walk && found->walk->joint)
      followed.common_sigma_s =
          std::max(followed.common_sigma_s, std::hypot(kUnseenOfWalks_s, found->walk->joint->sway_sigma_s));
    for (OffsetWindow& window :
         windows_of_stretch(*found, stretch, begin_s, search_scale(find_sweeps(part)))) {
      if (window.offset_s) {
        *window.offset_s += gone_s;
        if (!first_s) first_s = window.offset_s;
        last_s = window.offset_s;
      }
      followed.windows.push_back(std::move(window));
    }
    job.report("windows", stretch.end_s / recorded_s(recording));
  }
  return followed;
}

// The windows of a stationary rig and the course through them.
OffsetOverTime followed_in(const Recording& recording, const std::vector<RecordingPart>& windows,
                           double near_s, double duration_s, const OffsetSearch& search, const Job& job) {
  OffsetOverTime found{follow_offset(recording, windows, near_s, search.options.features, job), {}};
  found.course = course_of(found.windows, duration_s / 2);
  return found;
}

// Whether a course leaves windows far off it, or has so few that it could not be told from another one.
bool is_described(const OffsetOverTime& over_time) {
  constexpr std::size_t kMinWindows = 3;
  return over_time.course && over_time.course->windows >= kMinWindows &&
         std::ranges::none_of(parts_of_course(over_time), is_off_course);
}

// Of a stationary rig. Windows that no course describes, and few windows, are cut into shorter ones; these
// count where they describe more.
Result<OffsetOverTime> follow_stationary(const OffsetSearch& search, const RecordingSource& source,
                                         const Recording& planned, const EstimatePlan& plan, const Job& job) {
  const double near_s = search.coarse.offset_or(search.window.middle_s()),
               duration_s = recorded_s(source.outline());
  const MotorMotion& motor = search.problem.motor;
  OffsetOverTime found = followed_in(planned, plan.windows, near_s, duration_s, search, job);
  const bool fits = std::ranges::none_of(parts_of_course(found), is_off_course);
  std::vector<RecordingPart> windows = plan.windows;
  for (OffsetOverTime shorter = found; !is_described(shorter) && !job.cancelled();) {
    windows = shorter_windows(windows, motor, duration_s);
    if (windows.empty()) break;
    const auto parts = source.read(used_parts(windows, motor), job);
    if (!parts) return tl::unexpected(parts.error());
    shorter = followed_in(**parts, windows, near_s, duration_s, search, job);
    const bool as_constant = fits && found.course && shorter.course && shorter.course->constant();
    if (shorter.course && !as_constant) found = shorter;
  }
  return found;
}

// The windows of either kind of rig, and the standard deviation of the error that they have in common.
Result<std::pair<OffsetOverTime, double>> windows_followed(const OffsetSearch& search,
                                                           const RecordingSource& source,
                                                           const Recording& planned, const EstimatePlan& plan,
                                                           const Job& job) {
  using Followed = std::pair<OffsetOverTime, double>;
  if (!search.as_moving())
    return follow_stationary(search, source, planned, plan, job).map([](OffsetOverTime&& found) {
      return Followed{std::move(found), 0};
    });
  const auto whole = source.read({}, job);
  if (!whole) return tl::unexpected(whole.error());
  auto walk = follow_walk(**whole, plan.windows.front().end_s, search.options, job);
  if (!walk) return tl::unexpected(walk.error());
  OffsetOverTime found{std::move(walk->windows), {}};
  found.course = course_of(found.windows, recorded_s(source.outline()) / 2);
  return Followed{std::move(found), walk->common_sigma_s};
}

// Of a constant course through so few windows that a jump or a drift would not show in them: the whole is
// judged by its parts, as where nobody asked for the offset over time.
Result<void> judge_few_windows(const OffsetSearch& search, const OffsetOverTime& over_time,
                               const RecordingSource& source, Estimate& result, const Job& job) {
  constexpr std::size_t kMinWindows = 4;  // two on either side of a jump
  const OffsetCourse& course = *over_time.course;
  if (search.as_moving() || !result.identifiable || !course.constant() || course.windows >= kMinWindows)
    return {};
  EstimateOptions options = search.options;
  options.over_time_s.reset();
  const auto whole = find_offset(source, {}, options, {}, job);
  if (!whole) return tl::unexpected(whole.error());
  if (whole->identifiable) {
    result.sigma_s = std::max(*result.sigma_s, *whole->sigma_s);
    return {};
  }
  result.refusals = whole->refusals;
  result.identifiable = false;
  result.offset_s.reset();
  result.sigma_s.reset();
  return {};
}

// The offset at the recording's middle, as far as the windows let it stand.
void take_course(const OffsetSearch& search, const OffsetOverTime& over_time, double common_sigma_s,
                 Estimate& result) {
  const OffsetCourse& course = *over_time.course;
  OffsetEvidence evidence;
  evidence.parts = parts_of_course(over_time);
  const double sigma_s =
      std::hypot(course.sigma_s, common_sigma_s,
                 unseen_sigma_s(*search.problem.recording, search.problem.motor, course.offset_s));
  Verdict verdict = judge_course(evidence, sigma_s);
  for (const auto& [name, by_s] : verdict.widened) result.sigma_parts.push_back({name, by_s});
  for (Refusal& refused : verdict.refusals) result.refusals.push_back(std::move(refused));
  if (course.rate_sigma > 0) result.drift_ppm = course.rate * 1e6;
  result.identifiable = result.refusals.empty();
  if (!result.identifiable) return;
  result.offset_s = course.offset_s;
  result.sigma_s = verdict.sigma_s;
}

}  // namespace

Result<Estimate> follow_over_time(Estimate begun, const OffsetSearch& search, const RecordingSource& source,
                                  const Recording& planned, const EstimatePlan& plan, const Job& job) {
  auto followed = windows_followed(search, source, planned, plan, job);
  if (!followed) return tl::unexpected(followed.error());
  Estimate result = std::move(begun);
  result.curve = search.coarse.curve;
  if (job.cancelled()) return result;
  auto& [over_time, common_sigma_s] = *followed;
  if (over_time.course) {
    take_course(search, over_time, common_sigma_s, result);
    if (const auto judged = judge_few_windows(search, over_time, source, result, job); !judged)
      return tl::unexpected(judged.error());
  } else {
    result.refusals.push_back(refusal(RefusalKind::kNoWindow, {}, over_time.windows.front().reason));
  }
  if (plan.sample) {
    result.sweeps = plan.sample->counts.of_sweeps;
    result.scans = 0;
    for (const OffsetWindow& window : over_time.windows) result.scans += window.scans;
  }
  result.over_time = std::move(over_time);
  return result;
}

}  // namespace sweepscope
