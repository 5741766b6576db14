#include "core/offset/walk/joint_walk.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/walk/jerk_prior.hpp"
#include "core/offset/walk/walk_part.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Sweeps = std::vector<SweepPose>;

// A part shorter than this, 4 s of sweeps of 0.5 s, has little to say, and may say it wrongly.
constexpr std::size_t kMinSweeps = 8;

// Of longer walks than of this many parts, each part factorises once more rather than that all keep a factor.
constexpr std::size_t kKeptFactors = 12;

// The sweeps of one stretch cut into parts that are about equally long.
void cut(const Sweeps& run, double part_s, std::vector<Sweeps>& parts) {
  if (run.size() < kMinSweeps) return;
  const double duration_s = run.back().end_s - run.front().begin_s;
  const auto wanted = static_cast<std::size_t>(std::lround(duration_s / part_s));
  const std::size_t count =
      std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(1, run.size() / kMinSweeps));
  const std::size_t first = parts.size();
  parts.resize(first + count);
  for (std::size_t k = 0; k < run.size(); ++k) parts[first + k * count / run.size()].push_back(run[k]);
}

// No part holds sweeps that are lost, nor sweeps of two stretches, nor an end of a given motion.
std::vector<Sweeps> parts_of(const Sweeps& sweeps, double part_s, const GivenMotion* given) {
  std::vector<Sweeps> parts;
  for (const Sweeps& run : tracked_runs(sweeps, given)) cut(run, part_s, parts);
  return parts;
}

void summarise(JointWalk& walk) {
  double weights = 0, sum = 0, lever_m2 = 0, reach_m2 = 0;
  walk.converged = true;
  for (const JointWalkPart& part : walk.parts) {
    const double weight = 1 / (part.sigma_s * part.sigma_s);
    weights += weight;
    sum += weight * part.offset_s;
    if (!part.converged) walk.step_s += weight * std::abs(part.step_s);
    lever_m2 += part.lever_m2;
    reach_m2 += part.reach_m2;
    walk.features += part.features;
    walk.matches += part.matches;
    walk.converged = walk.converged && part.converged;
  }
  walk.offset_s = sum / weights;
  walk.step_s /= weights;
  walk.lever_m = std::sqrt(lever_m2 / double(walk.matches));
  walk.reach_m = std::sqrt(reach_m2 / double(walk.matches));
  walk.sigma_s = std::sqrt(1 / weights);
  // What the parts' own sigma leaves out (surfaces that are not flat, matches that are wrong) shows in how
  // they scatter. A few parts are a poor sample of it: the scatter on the walks of tests/benchmark/walks
  // counts as kPriorParts more.
  constexpr double kPriorParts = 4, kPriorScatter2 = 1.1;
  double scatter2 = kPriorParts * kPriorScatter2;
  for (const JointWalkPart& part : walk.parts)
    scatter2 +=
        (part.offset_s - walk.offset_s) * (part.offset_s - walk.offset_s) / part.sigma_s / part.sigma_s;
  std::vector<TimeShift> time_shifts;
  for (const JointWalkPart& part : walk.parts)
    if (part.time_shift) time_shifts.push_back(*part.time_shift);
  if (!time_shifts.empty()) walk.time_shift = mean_of(time_shifts);
  walk.sigma_s *= std::sqrt(std::max(1.0, scatter2 / (double(walk.parts.size() - 1) + kPriorParts)));
}

// What a sway in step with a motor that turns back smoothly may have been taken for: this share of the sway
// that was found, as the walks with such motors among the first 55 of tests/benchmark/random_walks err.
double sway_sigma_s(const OffsetProblem& problem, const Sweeps& sweeps) {
  constexpr double kShare = 0.4;
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  return kShare * alternating_sway_rad(sweeps, axis) / (2 * problem.motor.median_speed_rad_s);
}

// The walk of its parts. Absent where no part has enough matches.
std::optional<JointWalk> joined(const OffsetProblem& problem, const std::vector<Sweeps>& cuts,
                                const std::vector<std::optional<WalkPart>>& parts,
                                const JointWalkOptions& options) {
  const bool held = options.mapping.given && options.mapping.given->is_truth();
  const auto unseen_s = [&](const Sweeps& sweeps) {
    return held ? 0 : unseen_of_part_s(*problem.recording, problem.motor, sweeps.size());
  };
  JointWalk walk;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    JointWalkPart part = parts[i]->result();
    const bool matches = part.matches >= options.min_matches;
    for (const SweepPose& sweep : cuts[i])
      walk.sweeps.push_back(matches ? parts[i]->path().as_sweep(sweep) : sweep);
    if (!matches || !(part.sigma_s > 0)) continue;
    part.sigma_s = std::hypot(part.sigma_s, unseen_s(cuts[i]));
    walk.parts.push_back(part);
  }
  if (walk.parts.empty()) return std::nullopt;
  summarise(walk);
  walk.unseen_sigma_s = unseen_s(cuts.front()) / std::sqrt(double(walk.parts.size()));
  if (!options.mapping.given && !has_rings(*problem.recording) && turns_back_smoothly(problem))
    walk.sway_sigma_s = sway_sigma_s(problem, walk.sweeps);
  walk.sigma_s = std::hypot(walk.sigma_s, walk.sway_sigma_s);
  return walk;
}

}  // namespace

std::optional<JointWalk> solve_joint_walk(const OffsetProblem& problem, const std::vector<SweepPose>& tracked,
                                          double offset_s, const JointWalkOptions& options, const Job& job) {
  const std::vector<Sweeps> cuts = parts_of(tracked, options.part_s, options.mapping.given.get());
  std::vector<std::optional<WalkPart>> parts(cuts.size());
  std::atomic<std::size_t> done{0};
  const auto all = double(cuts.size()) * (options.first_iterations + options.averaged_iterations);
  const auto iterated = [&] { job.report("adjusting", std::min(1.0, double(++done) / all)); };
  for_each_index(cuts.size(), [&](std::size_t i) {
    parts[i].emplace(problem, cuts[i], offset_s, options);
    parts[i]->settle(job, iterated);
    if (cuts.size() > kKeptFactors) parts[i]->forget_factor();
  });
  if (job.cancelled()) return std::nullopt;
  auto walk = joined(problem, cuts, parts, options);
  if (!walk || options.averaged_iterations == 0 || std::abs(walk->offset_s - offset_s) > options.far_s)
    return walk;
  for_each_index(cuts.size(), [&](std::size_t i) { parts[i]->average(job, iterated); });
  if (job.cancelled()) return std::nullopt;
  return joined(problem, cuts, parts, options);
}

AdjustedWalk adjusted(const OffsetProblem& problem, std::vector<SweepPose> tracked, double offset_s,
                      const JointWalkOptions& options, const Job& job) {
  std::vector<Sweeps> pieces = parts_of(tracked, options.longest_s, options.mapping.given.get());
  std::atomic<std::size_t> done{0};
  const auto all = double(pieces.size()) * (options.rough_iterations + options.whole_iterations);
  const auto iterated = [&] { job.report("adjusting", std::min(1.0, double(++done) / all)); };
  std::vector<bool> held(pieces.size() + 1, false);  // whether a stretch goes on from the piece before
  for (std::size_t i = 1; i < pieces.size(); ++i)
    held[i] = pieces[i].front().stretch == pieces[i - 1].back().stretch;
  std::vector<MatchCount> counts(pieces.size());
  for_each_index(pieces.size(), [&](std::size_t i) {
    WalkPart part(problem, pieces[i], offset_s, options);
    counts[i] = part.adjust({held[i], held[i + 1]}, job, iterated);
    for (SweepPose& sweep : pieces[i]) sweep = part.path().as_sweep(std::move(sweep));
  });
  AdjustedWalk walk{std::move(tracked), {}};
  for (const MatchCount& count : counts) walk.count += count;
  for (Sweeps& piece : pieces)
    for (SweepPose& sweep : piece)
      *std::ranges::lower_bound(walk.sweeps, sweep.sweep, {}, &SweepPose::sweep) = std::move(sweep);
  return walk;
}

std::optional<Trend> drift_of(const JointWalk& walk) {
  constexpr double kUnseen_s = 0.2e-3;  // by which parts of hand-held walks scatter, whatever they say
  std::vector<double> middles_s, offsets_s, sigmas_s;
  for (const JointWalkPart& part : walk.parts) {
    middles_s.push_back(part.middle_s);
    offsets_s.push_back(part.offset_s);
    sigmas_s.push_back(std::hypot(part.sigma_s, kUnseen_s));
  }
  auto trend = trend_of(middles_s, offsets_s, sigmas_s);
  // Of a few parts that scatter by chance, some lie in a row. Between Student's factors for the 2 degrees of
  // freedom of 4 parts, 1.3 at one sigma and 2.2 at two.
  constexpr double kFewParts = 1.5;
  if (trend) trend->sigma *= kFewParts;
  return trend;
}

}  // namespace sweepscope
