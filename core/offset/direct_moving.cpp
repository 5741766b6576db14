#include "core/offset/direct_moving.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/moving.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

// n and e along the walk, below, at and above its offset.
std::vector<CurvePoint> sides(const OffsetProblem& problem, const SolvedWalk& walk,
                              const MovingDirectOptions& options) {
  std::vector<CurvePoint> curve(3);
  for_each_index(curve.size(), [&](std::size_t i) {
    const double offset_s = walk.joint->offset_s + (double(i) - 1) * options.side_s;
    curve[i] = moving_candidate(problem, offset_s, walk.sweeps, options.walk.mapping);
  });
  return curve;
}

}  // namespace

OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t most_sweeps) {
  OffsetProblem part = problem;
  const std::vector<std::size_t> sweep_of = assign_sweeps(part.recording->scans, part.motor.sweeps, offset_s);
  for (std::size_t i = 0; i < part.scan_used.size(); ++i)
    if (sweep_of[i] != kNoSweep && sweep_of[i] >= most_sweeps) part.scan_used[i] = 0;
  return part;
}

std::optional<MovingDirect> solve_moving(const OffsetProblem& problem, double first_offset_s,
                                         const MovingDirectOptions& options, const Job& job) {
  auto walk = solve_walk(problem, first_offset_s, options.walk, job);
  if (!walk) return std::nullopt;
  MovingDirect result;
  result.walk = std::move(*walk);
  if (!result.walk.joint) return result;
  result.converged = result.walk.near && result.walk.joint->converged;
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  result.sway_rad = alternating_sway_rad(result.walk.joint->sweeps, axis);
  result.curve = sides(problem, result.walk, options);
  if (job.cancelled()) return std::nullopt;
  return result;
}

}  // namespace sweepscope
