#include "core/offset/over_time/over_time.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/judgement/limits.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/search/coarse_search.hpp"
#include "core/offset/stationary/direct_stationary.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kSweepsOfWindow = 12;  // twice those of a group of sampled_sweeps

// Why a window cannot be answered, as far as it shows before the search.
MaybeRefusal unusable(const PreparedRecording& prepared, const OffsetProblem& problem,
                      const SearchScale& scale, double near_s) {
  const Recording& part = *prepared.recording;
  const double from_s = near_s - scale.half_width_s, to_s = near_s + scale.half_width_s;
  if (auto times = scan_times_refusal(part, scale)) return times;
  if (auto sparse = samples_refusal(part.motor, prepared.motor, scale)) return sparse;
  if (auto beams = beam_times_refusal(part, scale)) return beams;
  if (auto gaps = gaps_refusal(part, problem.scan_used, from_s, to_s)) return gaps;
  return lines_refusal(distinct_lines(part, prepared.motor, near_s));
}

struct CoarseAnswer {
  std::optional<double> offset_s;
  MaybeRefusal refused;
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
      answer.refused = refusal(RefusalKind::kFewSharedSurfaces, {}, "");
      continue;
    }
    answer.refused = edge_refusal(coarse.curve, *coarse.best);
    if (!answer.refused) answer.refused = flat_refusal(coarse.curve, *coarse.best, problem);
    if (!answer.refused) answer.refused = rival_refusal(coarse.curve, *coarse.best, scale);
    if (answer.refused) continue;
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
  const StationaryDirect found = solve_stationary(stationary_grid(problem), coarse_s, options, job);
  if (found.matches < options.min_matches)
    return window_without(
        window, refusal(RefusalKind::kFewMatches, double(found.matches), found.matches, found.features).text);
  if (const auto lever = lever_refusal(found.lever_m, found.reach_m))
    return window_without(window, lever->text);
  const auto sigma_s = sigma_of(found, *prepared.recording);
  if (const auto unsure = sigma_refusal(sigma_s, scale)) return window_without(window, unsure->text);
  if (!found.converged)
    return window_without(window, refusal(RefusalKind::kNotConverged, found.step_s * 1e3).text);
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
  if (part.scans.size() < kMinScansOfWindow) return window_without(window, kNoScans);
  const auto prepared = prepare(part, features, job);
  if (!prepared) return window_without(window, kInterruptedWindow);
  if (const auto motor = motor_refusal(part.motor, prepared->motor))
    return window_without(window, motor->text);
  const SearchScale scale = search_scale(prepared->motor);
  const OffsetProblem problem =
      problem_for(*prepared, near_s - scale.half_width_s, near_s + scale.half_width_s);
  if (const auto refused = unusable(*prepared, problem, scale, near_s))
    return window_without(window, refused->text);
  const CoarseAnswer coarse = coarse_offset(problem, scale, near_s, job);
  if (!coarse.offset_s)
    return window_without(window, coarse.refused ? coarse.refused->text : kInterruptedWindow);
  return solved(window, *prepared, problem, scale, *coarse.offset_s, recording.scans.front().first_beam_s,
                job);
}

}  // namespace

double recorded_s(const Recording& recording) {
  return recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
}

OffsetWindow window_without(const RecordingPart& window, std::string reason) {
  return {window.begin_s, window.end_s, (window.begin_s + window.end_s) / 2, {}, {}, std::move(reason)};
}

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

std::vector<RecordingPart> shorter_windows(const std::vector<RecordingPart>& windows,
                                           const MotorMotion& motor, double recorded_s) {
  const double min_s = double(kMinSweepsOfWindow) * motor.median_sweep_s;
  std::vector<RecordingPart> shorter =
      windows_of(recorded_s, std::max(min_s, recorded_s / double(windows.size()) / 2));
  if (shorter.size() <= windows.size()) shorter.clear();
  return shorter;
}

std::vector<RecordingPart> windows_over_time(const Recording& recording, const MotorMotion& motor,
                                             std::optional<double> asked_s) {
  const double whole_s = recorded_s(recording);
  return windows_of(whole_s, asked_s.value_or(0) > 0 ? *asked_s : default_window_s(motor, whole_s));
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

std::vector<PartOffset> parts_of_course(const OffsetOverTime& over_time) {
  std::vector<PartOffset> parts;
  if (!over_time.course) return parts;
  const OffsetCourse& course = *over_time.course;
  for (const OffsetWindow& window : over_time.windows) {
    if (!window.offset_s) continue;
    const bool in_jump = std::ranges::any_of(course.jumps, [&](const OffsetJump& jump) {
      return window.time_s > jump.begin_s && window.time_s < jump.end_s;
    });
    if (!in_jump)
      parts.push_back({window.time_s, *window.offset_s, course.offset_at_s(window.time_s),
                       course.scatter * *window.sigma_s});
  }
  return parts;
}

MaybeRefusal change_refusal(const OffsetOverTime& groups, double duration_s, double sweep_s) {
  constexpr double kChange_s = kLimits.max_change_s;
  const auto& course = groups.course;
  if (!course) return std::nullopt;
  OffsetEvidence evidence;
  evidence.duration_s = duration_s;
  evidence.min_window_s = double(kMinSweepsOfWindow) * sweep_s;
  for (const OffsetJump& jump : course->jumps)
    if (std::abs(jump.size_s) > kChange_s)
      return refusal(RefusalKind::kOffsetJumps, jump.size_s * 1e3, jump.size_s * 1e3, jump.begin_s,
                     jump.end_s, advice_on_change(evidence, (jump.begin_s + jump.end_s) / 2));
  if (std::abs(course->rate) * duration_s > kChange_s)
    return drift_refusal({course->rate, course->rate_sigma}, duration_s, course->sigma_s);
  for (const PartOffset& part : parts_of_course(groups)) {
    const double off_s = part.offset_s - part.expected_s;
    if (std::abs(off_s) > kChange_s && is_off_course(part))
      return refusal(RefusalKind::kOffsetChanges, off_s * 1e3, part.offset_s * 1e3, part.time_s,
                     part.expected_s * 1e3, kSearchOverTime);
  }
  return std::nullopt;
}

}  // namespace sweepscope
