#include "core/offset/walk/walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/loam/path/given_motion.hpp"
#include "core/loam/path/straighten.hpp"
#include "core/loam/relocalisation.hpp"
#include "core/offset/search/coarse_search.hpp"
#include "core/offset/walk/jerk_prior.hpp"

namespace sweepscope {

WalkOptions walk_options(const MappingOptions& mapping, const SearchScale& scale) {
  WalkOptions options;
  options.mapping = options.joint.mapping = mapping;
  options.step_tolerance_s = scale.unit_s / 2;
  options.max_step_s = 10 * scale.unit_s;
  options.max_sigma_s = scale.unit_s;
  return options;
}

namespace {

std::string worst_of(const std::vector<Contradiction>& contradictions, const Recording& recording) {
  if (contradictions.empty()) return "";
  return in_words(*std::ranges::max_element(contradictions, nearer, &Contradiction::apart),
                  recording.scans.front().first_beam_s);
}

constexpr double kHeld_s = 1e-9;         // of an offset that is not to be improved
constexpr std::size_t kStartsAgain = 2;  // of those tried at first

SolvedWalk with_track(SolvedWalk walk, const JudgedWalk& tracked, std::size_t min_sweeps,
                      const Recording& recording) {
  walk.lost = tracked.tracked() < min_sweeps;
  walk.sweeps = tracked.sweeps;
  walk.contradiction = worst_of(tracked.contradictions, recording);
  if (walk.starts.empty()) walk.starts = tracked.starts;
  return walk;
}

std::optional<SolvedWalk> iterate(const OffsetProblem& problem, double first_offset_s,
                                  const WalkOptions& options, const Job& job) {
  SolvedWalk walk;
  double offset_s = first_offset_s;
  MappingOptions mapping = options.mapping;
  JointWalkOptions joint = options.joint;
  JudgedWalk earlier;
  constexpr double kFarTolerances = 2;  // by judgement: the other iterations move the offset by less
  for (int pass = 0; pass < options.max_passes && !walk.near; ++pass) {
    auto tracked = track_and_judge(problem, offset_s, mapping, pass == 0 ? nullptr : &earlier, job);
    if (!tracked) return std::nullopt;
    mapping.starts = tracked->starts;
    mapping.starts.resize(std::min(tracked->starts.size(), tracked->well ? 1 : kStartsAgain));
    walk.tracked_at_s = offset_s;
    walk = with_track(std::move(walk), *tracked, options.min_sweeps, *problem.recording);
    earlier = std::move(*tracked);
    if (walk.lost) return walk;
    const bool last = pass + 1 == options.max_passes;
    joint.far_s = last ? std::numeric_limits<double>::infinity() : kFarTolerances * options.step_tolerance_s;
    walk.joint = solve_joint_walk(problem, walk.sweeps, offset_s, joint, job);
    if (job.cancelled()) return std::nullopt;
    if (!walk.joint) return walk;
    const double step_s = walk.joint->offset_s - offset_s;
    if (walk.joint->sigma_s > options.max_sigma_s) return walk;
    walk.near = std::abs(step_s) < options.step_tolerance_s;
    if (walk.joint->time_shift && mapping.given) {
      const double shift_s = walk.joint->time_shift->time_s;
      walk.near = walk.near && std::abs(shift_s - mapping.given->time_shift_s()) < options.shift_tolerance_s;
      mapping.given = std::make_shared<const GivenMotion>(mapping.given->with_time_shift(shift_s));
      joint.mapping.given = mapping.given;
    }
    offset_s += std::clamp(step_s, -options.max_step_s, options.max_step_s);
  }
  return walk;
}

// Straightened and adjusted, its stretches on one map.
std::optional<SolvedWalk> finished(const OffsetProblem& problem, SolvedWalk walk,
                                   const MappingOptions& mapping, const Job& job) {
  if (!mapping.given && !turns_back_smoothly(problem)) walk.sweeps = straightened(std::move(walk.sweeps));
  JointWalkOptions joint;
  joint.mapping = mapping;
  if (problem.motor.one_way()) joint.offset_sigma_s = kHeld_s;
  if (!mapping.given || !mapping.given->is_truth()) {
    AdjustedWalk whole = adjusted(problem, std::move(walk.sweeps), walk.tracked_at_s, joint, job);
    walk.sweeps = std::move(whole.sweeps);
    if (whole.count.features > 0) walk.misfit_m = whole.count.misfit_m();
  }
  SweepPlacer placer(problem, walk.tracked_at_s);
  const auto place = [&](std::size_t i) {
    PlacedSweep sweep;
    placer.place(i, sweep);
    return sweep;
  };
  walk.sweeps = relocalised(std::move(walk.sweeps), place, mapping, job);
  if (job.cancelled()) return std::nullopt;
  return walk;
}

// At an offset that is not to be improved.
std::optional<SolvedWalk> solve_walk_at(const OffsetProblem& problem, double offset_s,
                                        const MappingOptions& mapping, const Job& job) {
  WalkOptions options;
  options.mapping = options.joint.mapping = mapping;
  options.joint.offset_sigma_s = kHeld_s;
  return solve_walk(problem, offset_s, options, job);
}

}  // namespace

std::optional<SolvedWalk> solve_walk(const OffsetProblem& problem, double first_offset_s,
                                     const WalkOptions& options, const Job& job) {
  auto walk = iterate(problem, first_offset_s, options, job);
  return walk ? finished(problem, std::move(*walk), options.mapping, job) : walk;
}

std::optional<SolvedWalk> track_again(const OffsetProblem& problem, SolvedWalk walk, MappingOptions mapping,
                                      const Job& job) {
  mapping.starts = walk.starts;
  mapping.starts.resize(std::min(walk.starts.size(), kStartsAgain));
  const auto tracked = track_and_judge(problem, walk.tracked_at_s, mapping, nullptr, job);
  if (!tracked) return std::nullopt;
  walk = with_track(std::move(walk), *tracked, WalkOptions().min_sweeps, *problem.recording);
  return finished(problem, std::move(walk), mapping, job);
}

std::optional<SolvedWalk> track_from(const OffsetProblem& problem, SolvedWalk walk, KnownSweeps known,
                                     const MappingOptions& mapping, const Job& job) {
  const auto tracked = track_from(problem, walk.tracked_at_s, std::move(known), mapping, job);
  if (!tracked) return std::nullopt;
  walk = with_track(std::move(walk), *tracked, WalkOptions().min_sweeps, *problem.recording);
  return finished(problem, std::move(walk), mapping, job);
}

std::optional<SolvedWalk> find_walk(const OffsetProblem& problem, double middle_s,
                                    const MappingOptions& mapping, WalkPurpose purpose, const Job& job) {
  const SearchScale scale = search_scale(problem.motor);
  if (problem.motor.one_way()) return solve_walk_at(problem, middle_s, mapping, job);
  const CoarseSearch coarse =
      search_coarsely(problem, middle_s - scale.half_width_s, middle_s + scale.half_width_s, scale, job);
  if (job.cancelled()) return std::nullopt;
  WalkOptions options = walk_options(mapping, scale);
  if (purpose == WalkPurpose::kTrajectory) options.joint.averaged_iterations = 0;
  return solve_walk(problem, coarse.offset_or(middle_s), options, job);
}

namespace {

double length_s(const std::vector<Interval>& intervals) {
  double sum_s = 0;
  for (const Interval& interval : intervals) sum_s += interval.end_s - interval.begin_s;
  return sum_s;
}

// The fastest that the rig turned while it was followed.
double followed_rad_s(const std::vector<SweepPose>& sweeps) {
  double fastest_rad_s = 0;
  for (const SweepPose& sweep : sweeps)
    if (!sweep.lost)
      for (const Vector6d& twist_per_s : twists_per_s(sweep, 2))
        fastest_rad_s = std::max(fastest_rad_s, twist_per_s.head<3>().norm());
  return fastest_rad_s;
}

}  // namespace

std::vector<Interval> lost_times(const std::vector<SweepPose>& sweeps, const Recording& recording) {
  constexpr double kMin_s = 0.05;  // printed as 0.1 s: of a sweep at an end the scans may hold less
  std::vector<Interval> lost = lost_intervals(sweeps);
  const double first_s = recording.scans.front().first_beam_s;
  const double end_s = recording.scans.back().last_beam_s();
  std::erase_if(lost, [&](const Interval& interval) {
    return std::min(interval.end_s, end_s) - std::max(interval.begin_s, first_s) < kMin_s;
  });
  for (Interval& interval : lost) {
    interval.begin_s = std::max(0.0, interval.begin_s - first_s);
    interval.end_s -= first_s;
  }
  return lost;
}

std::optional<std::string> lost_warning(const std::vector<Interval>& lost) {
  if (lost.empty()) return std::nullopt;
  std::string when;
  constexpr std::size_t kMax = 5;  // a sentence holds no more
  for (std::size_t i = 0; i < std::min(kMax, lost.size()); ++i)
    when += fmt::format("{}{:.1f} to {:.1f} s", i == 0 ? "" : ", ", lost[i].begin_s, lost[i].end_s);
  if (lost.size() > kMax) when += fmt::format(" and {} more times", lost.size() - kMax);
  return fmt::format("The motion could not be followed for {:.1f} s, which are left out: {}.", length_s(lost),
                     when);
}

std::optional<std::string> pieces_warning(const std::vector<SweepPose>& sweeps, const Recording& recording) {
  std::vector<std::size_t> pieces;
  std::string from;
  constexpr std::size_t kMax = 5;  // a sentence holds no more
  for (const SweepPose& sweep : sweeps) {
    if (sweep.stretch == 0 || std::ranges::find(pieces, sweep.stretch) != pieces.end()) continue;
    pieces.push_back(sweep.stretch);
    if (pieces.size() == 1 || pieces.size() > kMax + 1) continue;
    const double begins_s = sweep.begin_s - recording.scans.front().first_beam_s;
    from += fmt::format("{}{:.1f} s", from.empty() ? "" : ", ", begins_s);
  }
  if (pieces.size() < 2) return std::nullopt;
  return fmt::format(
      "The map is in {} pieces that do not fit each other: the motion could not be followed, and the "
      "positions of the pieces from {} on are guesses.",
      pieces.size(), from);
}

Refusal lost_refusal(const SolvedWalk& walk, const Recording& recording) {
  const std::vector<Interval> lost = lost_times(walk.sweeps, recording);
  const auto tracked = std::ranges::count(walk.sweeps, false, &SweepPose::lost);
  if (lost.empty())
    return refusal(RefusalKind::kTrackLost, double(tracked),
                   fmt::format("Only {} sweeps could be followed, and {} are required. Record a longer walk.",
                               tracked, kLimits.min_tracked_sweeps));
  std::string text = fmt::format("The motion could not be followed for {:.1f} s, first at {:.1f} s",
                                 length_s(lost), lost.front().begin_s);
  const double followed_deg_s = followed_rad_s(walk.sweeps) / kRadPerDeg;
  if (followed_deg_s > 1) text += fmt::format("; turns of up to {:.0f} deg/s were followed", followed_deg_s);
  return refusal(RefusalKind::kTrackLost, double(tracked),
                 text + ". Turn more slowly, at most by 40 deg/s, above all in the first 5 s.");
}

}  // namespace sweepscope
