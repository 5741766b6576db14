#include "core/offset/estimate_over_time.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/find_offset.hpp"
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
         windows_of_stretch(*found, stretch, begin_s, search_scale(find_sweeps(part.motor)))) {
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

// The windows of either kind of rig.
Result<FollowedWalk> windows_followed(const OffsetSearch& search, const RecordingSource& source,
                                      const Recording& planned, const EstimatePlan& plan, const Job& job) {
  const double near_s = search.coarse.offset_or(search.window.middle_s());
  if (!search.as_moving())
    return FollowedWalk{follow_offset(planned, plan.windows, near_s, search.options.features, job), 0};
  return source.read({}, job).and_then([&](const std::shared_ptr<const Recording>& whole) {
    return follow_walk(*whole, plan.windows.front().end_s, search.options, job);
  });
}

}  // namespace

Result<Estimate> follow_over_time(Estimate begun, const OffsetSearch& search, const RecordingSource& source,
                                  const Recording& planned, const EstimatePlan& plan, const Job& job) {
  auto followed = windows_followed(search, source, planned, plan, job);
  if (!followed) return tl::unexpected(followed.error());
  Estimate result = std::move(begun);
  result.curve = search.coarse.curve;
  if (job.cancelled()) return result;
  OffsetOverTime over_time{std::move(followed->windows), {}};
  over_time.course = course_of(over_time.windows, recorded_s(source.outline()) / 2);
  if (const auto& course = over_time.course) {
    result.identifiable = true;
    result.offset_s = course->offset_s;
    result.sigma_s =
        std::hypot(course->sigma_s, followed->common_sigma_s,
                   unseen_sigma_s(*search.problem.recording, search.problem.motor, course->offset_s));
    if (course->rate_sigma > 0) result.drift_ppm = course->rate * 1e6;
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
