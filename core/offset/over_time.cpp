#include "core/offset/over_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/offset/coarse_search.hpp"
#include "core/offset/direct_stationary.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/walk.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kSweepsOfWindow = 12;     // twice those of a group of sampled_sweeps
constexpr std::size_t kMinScans = 3;            // fewer have no sweep
constexpr double kUnseenOfWalks_s = 0.1e-3;     // common error of all parts of a walk: see mean_of
constexpr double kUnseenOfWalkPart_s = 0.2e-3;  // scatter of the parts beyond their sigmas: see drift_of
constexpr const char* kNoScans = "There are no scans.";

OffsetWindow gap(const RecordingPart& window, std::string reason) {
  return {window.begin_s, window.end_s, (window.begin_s + window.end_s) / 2, {}, {}, std::move(reason)};
}

double recorded_s(const Recording& recording) {
  return recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
}

// The reason why a window cannot be answered, as far as it shows before the search.
Remark unusable_reason(const PreparedRecording& prepared, const OffsetProblem& problem,
                       const SearchScale& scale, double near_s) {
  const Recording& part = *prepared.recording;
  if (const auto reasons = motor_reasons(part.motor, prepared.motor); !reasons.empty())
    return reasons.front();
  if (const auto stamps = stamps_reason(part, scale)) return stamps;
  if (const auto sparse = sampling_reason(part.motor, prepared.motor, scale)) return sparse;
  if (const auto beams = beam_times_reason(part, scale)) return beams;
  if (auto gaps =
          gaps_reason(part, problem.scan_used, near_s - scale.half_width_s, near_s + scale.half_width_s))
    return gaps;
  return lines_reason(distinct_lines(part, prepared.motor, near_s));
}

struct CoarseAnswer {
  std::optional<double> offset_s;
  Remark reason;
};

// Searches near `near_s` first, then over the default window.
CoarseAnswer coarse_offset(const OffsetProblem& problem, const SearchScale& scale, double near_s,
                           const Job& job) {
  constexpr double kNear = 10;  // units
  CoarseAnswer answer;
  for (const double half_s : {std::min(kNear * scale.unit_s, scale.half_width_s), scale.half_width_s}) {
    const CoarseSearch coarse = search_coarsely(problem, near_s - half_s, near_s + half_s, scale, job);
    if (job.cancelled()) return answer;
    if (!coarse.best) {
      answer.reason = "Too few surfaces were measured in both directions.";
      continue;
    }
    answer.reason = edge_reason(coarse.curve, *coarse.best);
    if (!answer.reason) answer.reason = flat_reason(coarse.curve, *coarse.best);
    if (!answer.reason) answer.reason = rival_reason(coarse.curve, *coarse.best, scale);
    if (answer.reason) continue;
    answer.offset_s = coarse.offset_s();
    return answer;
  }
  return answer;
}

// The least squares of a window, or the reason why it gives no offset.
OffsetWindow solved(const RecordingPart& window, const PreparedRecording& prepared,
                    const OffsetProblem& problem, const SearchScale& scale, double coarse_s,
                    double recording_begin_s, const Job& job) {
  StationaryDirectOptions options;
  options.resampling = Resampling::kParts;
  const StationaryDirect found = solve_stationary(still_grid(problem), coarse_s, options, job);
  if (found.matches < options.min_matches)
    return gap(window,
               fmt::format("Only {} of {} points lie on surfaces that were measured in the other direction.",
                           found.matches, found.features));
  if (auto lever = lever_reason(found.lever_m, found.reach_m)) return gap(window, *lever);
  const auto sigma_s = sigma_of(found, *prepared.recording);
  if (auto unsure = sigma_reason(sigma_s, scale)) return gap(window, *unsure);
  if (!found.converged && std::abs(found.step_s) > *sigma_s)
    return gap(window, "The least squares did not converge.");
  return {window.begin_s, window.end_s, found.middle_s - recording_begin_s, found.offset_s,
          sigma_s,        {},           prepared.recording->scans.size()};
}

// The sweeps about the window's middle.
RecordingPart used_part(const RecordingPart& window, double sweep_s) {
  const double used_s = std::min(window.end_s - window.begin_s, double(kSweepsOfWindow) * sweep_s);
  const double middle_s = (window.begin_s + window.end_s) / 2;
  return {middle_s - used_s / 2, middle_s + used_s / 2};
}

OffsetWindow offset_of(const Recording& recording, const RecordingPart& window, double sweep_s, double near_s,
                       const FeatureOptions& features, const Job& job) {
  const RecordingPart used = used_part(window, sweep_s);
  const Recording part = sweepscope::window(recording, used.begin_s, used.end_s, 1 + std::abs(near_s));
  if (part.scans.size() < kMinScans) return gap(window, kNoScans);
  const auto prepared = prepare(part, features, job);
  if (!prepared) return gap(window, "Interrupted.");
  if (const auto reasons = motor_reasons(part.motor, prepared->motor); !reasons.empty())
    return gap(window, reasons.front());
  const SearchScale scale = search_scale(prepared->motor);
  const OffsetProblem problem =
      problem_for(*prepared, near_s - scale.half_width_s, near_s + scale.half_width_s);
  if (auto unusable = unusable_reason(*prepared, problem, scale, near_s)) return gap(window, *unusable);
  const CoarseAnswer coarse = coarse_offset(problem, scale, near_s, job);
  if (!coarse.offset_s) return gap(window, coarse.reason.value_or("Interrupted."));
  return solved(window, *prepared, problem, scale, *coarse.offset_s, recording.scans.front().first_beam_s,
                job);
}

// The parts of a walk as windows. Times are seconds since the recording's first scan.
void append_parts(const SolvedWalk& walk, const RecordingPart& stretch, double begin_s,
                  const SearchScale& scale, std::vector<OffsetWindow>& windows) {
  const std::vector<JointWalkPart>& parts = walk.joint->parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto between_s = [&](std::size_t one, std::size_t other) {
      return (parts[one].middle_s + parts[other].middle_s) / 2 - begin_s;
    };
    const double middle_s = parts[i].middle_s - begin_s;
    const RecordingPart window{i == 0 ? stretch.begin_s : between_s(i - 1, i),
                               i + 1 == parts.size() ? stretch.end_s : between_s(i, i + 1)};
    if (auto unsure = sigma_reason(parts[i].sigma_s, scale))
      windows.push_back(gap(window, *unsure));
    else
      windows.push_back({window.begin_s,
                         window.end_s,
                         middle_s,
                         parts[i].offset_s,
                         std::hypot(parts[i].sigma_s, kUnseenOfWalkPart_s),
                         {}});
  }
}

// The rig moved in a stretch, or it was stationary, or there is no answer.
void append_stretch(const Estimate& found, const Recording& part, const RecordingPart& stretch,
                    double begin_s, FollowedWalk& followed) {
  if (!found.identifiable) {
    followed.windows.push_back(
        gap(stretch, found.reasons.empty() ? "There is no answer." : found.reasons.front()));
  } else if (found.walk && found.walk->joint) {
    followed.common_sigma_s =
        std::max(followed.common_sigma_s, std::hypot(kUnseenOfWalks_s, found.walk->joint->sway_sigma_s));
    append_parts(*found.walk, stretch, begin_s, search_scale(find_sweeps(part.motor)), followed.windows);
  } else {
    followed.windows.push_back({stretch.begin_s,
                                stretch.end_s,
                                (stretch.begin_s + stretch.end_s) / 2,
                                found.offset_s,
                                found.sigma_s,
                                {}});
  }
}

}  // namespace

double default_window_s(const MotorMotion& motor, double recorded_s) {
  constexpr double kMin_s = 10, kMaxWindows = 360;  // of an hour
  return std::max(
      {kMin_s, std::ceil(double(kSweepsOfWindow) * motor.median_sweep_s), recorded_s / kMaxWindows});
}

std::vector<RecordingPart> windows_of(double recorded_s, double window_s) {
  const auto count = std::max<std::size_t>(1, std::size_t(std::floor(recorded_s / window_s + 1e-6)));
  std::vector<RecordingPart> windows;
  windows.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    windows.push_back({recorded_s * double(i) / double(count), recorded_s * double(i + 1) / double(count)});
  return windows;
}

std::vector<RecordingPart> windows_over_time(const Recording& recording, const MotorMotion& motor,
                                             const EstimateOptions& options) {
  const double asked_s = options.over_time_s.value_or(0), whole_s = recorded_s(recording);
  return windows_of(whole_s, asked_s > 0 ? asked_s : default_window_s(motor, whole_s));
}

std::vector<RecordingPart> used_parts(const std::vector<RecordingPart>& windows, const MotorMotion& motor) {
  std::vector<RecordingPart> parts;
  parts.reserve(windows.size());
  for (const RecordingPart& window : windows) parts.push_back(used_part(window, motor.median_sweep_s));
  return parts;
}

std::vector<OffsetWindow> follow_offset(const Recording& recording, const std::vector<RecordingPart>& windows,
                                        double first_offset_s, const FeatureOptions& features,
                                        const Job& job) {
  constexpr std::size_t kTogether = 8;  // windows searched in parallel, from the same offset
  const double sweep_s = find_sweeps(recording.motor).median_sweep_s;
  std::vector<OffsetWindow> found(windows.size());
  double near_s = first_offset_s;
  for (std::size_t first = 0; first < windows.size() && !job.cancelled(); first += kTogether) {
    const std::size_t count = std::min(kTogether, windows.size() - first);
    const Job part_of_job = Job::part_of(job);
    for_each_task(count, [&](std::size_t i) {
      found[first + i] = offset_of(recording, windows[first + i], sweep_s, near_s, features, part_of_job);
    });
    for (std::size_t i = first; i < first + count; ++i) near_s = found[i].offset_s.value_or(near_s);
    job.report("windows", double(first + count) / double(windows.size()));
  }
  return found;
}

Result<FollowedWalk> follow_walk(const Recording& recording, double window_s,
                                 const EstimatePart& estimate_part, const Job& job) {
  // Half a minute has three parts of JointWalkOptions, the fewest whose scatter is known. Offsets that have
  // drifted by more than 10 ms are followed, so that they stay well within the default search.
  constexpr double kStretch_s = 30, kFar_s = 0.010;
  const double begin_s = recording.scans.front().first_beam_s;
  FollowedWalk followed{{}, kUnseenOfWalks_s};
  std::optional<double> first_s, last_s;
  for (const RecordingPart& stretch : windows_of(recorded_s(recording), std::max(kStretch_s, window_s))) {
    // Where the offset has drifted far, the motor's stamps are shifted back into the search window.
    const double gone_s = first_s && std::abs(*last_s - *first_s) > kFar_s ? *last_s - *first_s : 0;
    Recording part = window(recording, stretch.begin_s, stretch.end_s, 1 + std::abs(gone_s));
    for (double& time_s : part.motor.time_s) time_s -= gone_s;
    if (part.scans.size() < kMinScans) {
      followed.windows.push_back(gap(stretch, kNoScans));
      continue;
    }
    const auto found = estimate_part(part);
    if (!found) return tl::unexpected(found.error());
    if (job.cancelled()) return followed;
    const std::size_t before = followed.windows.size();
    append_stretch(*found, part, stretch, begin_s, followed);
    for (std::size_t i = before; i < followed.windows.size(); ++i) {
      auto& offset_s = followed.windows[i].offset_s;
      if (!offset_s) continue;
      *offset_s += gone_s;
      if (!first_s) first_s = offset_s;
      last_s = offset_s;
    }
    job.report("windows", stretch.end_s / recorded_s(recording));
  }
  return followed;
}

Result<Answer> answer_over_time(const OffsetSearch& search, const Recording& whole,
                                const EstimatePart& estimate_part, const Job& job) {
  const OffsetProblem& problem = search.problem;
  Answer answer;
  answer.curve = search.coarse.curve;
  const auto windows = windows_over_time(whole, problem.motor, search.options);
  OffsetOverTime over_time;
  double common_sigma_s = 0;
  if (search.as_moving()) {
    auto followed = follow_walk(whole, windows.front().end_s, estimate_part, job);
    if (!followed) return tl::unexpected(followed.error());
    over_time.windows = std::move(followed->windows);
    common_sigma_s = followed->common_sigma_s;
  } else {
    over_time.windows = follow_offset(whole, windows, search.coarse.offset_or(search.window.middle_s()),
                                      search.options.features, job);
  }
  if (job.cancelled()) return answer;
  over_time.course = course_of(over_time.windows, recorded_s(whole) / 2);
  if (const auto& course = over_time.course) {
    answer.offset_s = course->offset_s;
    answer.sigma_s = std::hypot(course->sigma_s, common_sigma_s,
                                unseen_sigma_s(*problem.recording, problem.motor, course->offset_s));
    if (course->rate_sigma > 0) answer.drift_ppm = course->rate * 1e6;
  } else {
    answer.reasons.push_back("No window determines the offset. The first: " +
                             over_time.windows.front().reason);
  }
  answer.over_time = std::move(over_time);
  return answer;
}

OffsetOverTime follow_groups(const Recording& sample, const std::vector<RecordingPart>& groups,
                             double first_offset_s, const FeatureOptions& features, const Job& job) {
  const double sweep_s = find_sweeps(sample.motor).median_sweep_s;
  OffsetOverTime found;
  std::optional<OffsetWindow> before, last;
  for (const RecordingPart& group : groups) {
    if (job.cancelled()) return found;
    double near_s = last ? *last->offset_s : first_offset_s;
    if (before)
      near_s += (*last->offset_s - *before->offset_s) / (last->time_s - before->time_s) *
                ((group.begin_s + group.end_s) / 2 - last->time_s);
    found.windows.push_back(offset_of(sample, group, sweep_s, near_s, features, job));
    if (!found.windows.back().offset_s) continue;
    before = std::move(last);
    last = found.windows.back();
  }
  found.course = course_of(found.windows, recorded_s(sample) / 2);
  return found;
}

MotorTrack without_course(const Recording& recording, const OffsetCourse& course) {
  MotorTrack track;
  const double begin_s = recording.scans.front().first_beam_s;
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i) {
    const double motor_s = recording.motor.time_s[i];
    const double time_s = motor_s - course.offset_at_s(motor_s - course.offset_s - begin_s);
    if (!track.time_s.empty() && time_s <= track.time_s.back()) continue;
    track.time_s.push_back(time_s);
    track.angle_rad.push_back(recording.motor.angle_rad[i]);
  }
  return track;
}

Remark change_reason(const OffsetOverTime& groups, double duration_s) {
  constexpr double kChange_s = 1e-3;  // blurs a map visibly
  constexpr double kSigmas = 5;       // of one window among ten
  const auto& course = groups.course;
  if (!course) return std::nullopt;
  const char* advice = "Search over time to follow it (estimate --over-time).";
  for (const OffsetJump& jump : course->jumps)
    if (std::abs(jump.size_s) > kChange_s)
      return fmt::format("The offset jumps by {:.1f} ms between {:.1f} and {:.1f} s. {}", jump.size_s * 1e3,
                         jump.begin_s, jump.end_s, advice);
  if (std::abs(course->rate) * duration_s > kChange_s)
    return drift_reason({course->rate, course->rate_sigma}, duration_s, course->sigma_s);
  for (const OffsetWindow& window : groups.windows) {
    if (!window.offset_s) continue;
    const double off_s = *window.offset_s - course->offset_at_s(window.time_s);
    if (std::abs(off_s) > std::max(kChange_s, kSigmas * course->scatter * *window.sigma_s))
      return fmt::format("The offset changes: it is {:.1f} ms near {:.1f} s and {:.1f} ms elsewhere. {}",
                         *window.offset_s * 1e3, window.time_s, course->offset_at_s(window.time_s) * 1e3,
                         advice);
  }
  return std::nullopt;
}

}  // namespace sweepscope
