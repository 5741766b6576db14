#include "core/offset/direct/direct_moving.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/criteria/moving_candidate.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

// n and e along the walk, below, at and above its offset.
std::vector<CurvePoint> sides(const OffsetProblem& problem, const SolvedWalk& walk,
                              const MovingDirectOptions& options, const Job& job) {
  std::vector<CurvePoint> curve(3);
  for_each_index(curve.size(), [&](std::size_t i) {
    const double offset_s = walk.joint->offset_s + (double(i) - 1) * options.side_s;
    curve[i] = moving_candidate(problem, offset_s, walk.sweeps, options.walk.mapping, job);
  });
  return curve;
}

}  // namespace

std::optional<MovingDirect> solve_moving(const OffsetProblem& problem, double first_offset_s,
                                         const MovingDirectOptions& options, const Job& job) {
  auto walk = solve_walk(problem, first_offset_s, options.walk, job);
  if (!walk) return std::nullopt;
  MovingDirect result;
  if (walk->joint) {
    result.converged = walk->near && walk->joint->converged;
    const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
    result.sway_rad = alternating_sway_rad(walk->joint->sweeps, axis);
    job.report("comparing", 0);
    result.curve = sides(problem, *walk, options, job);
  }
  result.walk = std::make_shared<const SolvedWalk>(std::move(*walk));
  if (job.cancelled()) return std::nullopt;
  return result;
}

}  // namespace sweepscope
