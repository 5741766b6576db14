#include "core/offset/search/stationary_part.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/search/stationary_fit.hpp"

namespace sweepscope {
namespace {

double length_s(const RecordingPart& part) {
  return part.end_s - part.begin_s;
}

// Parts in which the rig may have been stationary, to be looked at line by line.
std::vector<RecordingPart> likely_parts(const PreparedRecording& prepared,
                                        const std::vector<MotionPart>& parts) {
  constexpr std::size_t kFewSweeps = 20;  // a motion may begin within each pair of the same direction
  const MotorMotion& motor = prepared.motor;
  std::vector<RecordingPart> likely;
  // The first pair that moved begins a sweep after the last that did not.
  for (const MotionPart& part : parts)
    if (!part.moved) likely.push_back({part.begin_s, part.end_s + motor.median_sweep_s});
  std::ranges::stable_sort(likely, std::greater<>(), length_s);
  if (!likely.empty()) likely.resize(1);
  if (motor.sweeps.size() > kFewSweeps) return likely;
  const double first_s = prepared.recording->scans.front().first_beam_s;
  for (std::size_t i = 0; i + 1 < motor.sweeps.size(); ++i)
    likely.push_back({motor.sweeps[i].begin_s - first_s, motor.sweeps[i + 1].end_s - first_s});
  return likely;
}

// From a group of lines that is stationary as far as there are others that follow each other. One next to a
// group that moved may already have moved in part, and is left out.
struct LastStationary {
  std::optional<MotionPart> group;
  bool is_last = false;  // of all groups
};
template <typename Groups>
LastStationary last_stationary(const Groups& groups, double max_gap_s) {
  std::optional<MotionPart> before, last;
  for (const MotionPart& group : groups) {
    const double gap_s = last ? std::max(group.begin_s - last->end_s, last->begin_s - group.end_s) : 0;
    if (gap_s > max_gap_s) return {last};
    if (group.moved) return {before};
    before = last;
    last = group;
  }
  return {last, true};
}

// The part round a likely one that its scan lines show to be stationary.
std::optional<RecordingPart> seen_part(const PreparedRecording& prepared, const RecordingPart& likely,
                                       const Job& job) {
  constexpr double kFitSweeps = 8;  // for an offset at which lines can be compared
  const Recording& recording = *prepared.recording;
  const double sweep_s = prepared.motor.median_sweep_s;
  const double fit_end_s = std::min(likely.end_s, likely.begin_s + kFitSweeps * sweep_s);
  const StationaryFit fit = fit_stationary(window(recording, likely.begin_s, fit_end_s), job);
  if (!fit.fits || job.cancelled()) return std::nullopt;
  const OffsetProblem problem = problem_for(prepared, fit.direct.offset_s, fit.direct.offset_s);
  const std::vector<MotionPart> groups =
      motion_of_lines(stationary_grid(problem), fit.direct.offset_s, likely);
  const double middle_s = (likely.begin_s + likely.end_s) / 2;
  const auto from = std::ranges::lower_bound(groups, middle_s, {}, &MotionPart::begin_s);
  const auto [first, to_begin] =
      last_stationary(std::ranges::subrange(std::make_reverse_iterator(from), groups.rend()), sweep_s);
  const auto [last, to_end] = last_stationary(std::ranges::subrange(from, groups.end()), sweep_s);
  if (!first || !last) return std::nullopt;
  const double duration_s = recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
  const RecordingPart turning{first->begin_s, last->end_s};
  // Where the motor did not turn nothing is seen, and nothing is used.
  if (length_s(turning) < std::max(3.0, 1.5 * sweep_s)) return std::nullopt;
  const double begin_s = to_begin && turning.begin_s < sweep_s ? 0 : turning.begin_s,
               end_s = to_end && duration_s - turning.end_s < sweep_s ? duration_s : turning.end_s;
  return RecordingPart{std::ceil(begin_s * 10) / 10, std::floor(end_s * 10) / 10};
}

// The parts with one of them known to be stationary: to either side of it the rig moved.
std::vector<MotionPart> with_stationary(const std::vector<MotionPart>& parts, const RecordingPart& part,
                                        double duration_s) {
  std::vector<MotionPart> all;
  for (const MotionPart& other : parts)
    if (other.begin_s < part.begin_s)
      all.push_back({other.begin_s, std::min(other.end_s, part.begin_s), other.moved});
  if (!all.empty()) all.back().moved = true;
  all.push_back({part.begin_s, part.end_s, false});
  double end_s = part.end_s;
  for (const MotionPart& other : parts) {
    if (other.end_s <= end_s) continue;
    all.push_back({end_s, other.end_s, other.moved || end_s == part.end_s});
    end_s = other.end_s;
  }
  if (end_s == part.end_s && end_s < duration_s) all.push_back({end_s, duration_s, true});
  return all;
}

}  // namespace

MotionCourse motion_course(const PreparedRecording& prepared, const Job& job) {
  MotionCourse course{motion_over_time(prepared), {}};
  if (prepared.recording->scans.empty() || prepared.motor.sweeps.size() < 2) return course;
  if (!course.parts.empty() && std::ranges::none_of(course.parts, &MotionPart::moved)) return course;
  for (const RecordingPart& likely : likely_parts(prepared, course.parts)) {
    const auto seen = seen_part(prepared, likely, job);
    if (job.cancelled()) return course;
    if (seen && (!course.stationary || length_s(*seen) > length_s(*course.stationary)))
      course.stationary = seen;
  }
  const auto& scans = prepared.recording->scans;
  if (course.stationary)
    course.parts = with_stationary(course.parts, *course.stationary,
                                   scans.back().first_beam_s - scans.front().first_beam_s);
  return course;
}

}  // namespace sweepscope
