#include "core/offset/direct_moving.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/candidates.hpp"
#include "core/offset/uncertainty.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

// n and e along the joint walk, below, at and above its offset.
std::vector<CurvePoint> sides(const OffsetProblem& problem, const JointWalk& walk,
                              const MovingDirectOptions& options) {
  std::vector<CurvePoint> curve(3);
  for_each_index(curve.size(), [&](std::size_t i) {
    CurvePoint& point = curve[i];
    point.offset_s = walk.offset_s + (double(i) - 1) * options.side_s;
    const MatchCount count = count_matches(problem, point.offset_s, walk.sweeps, options.mapping);
    point.n = double(count.matches);
    if (count.features > 0) point.capped_cost_m = count.capped_cost_m();
    if (count.matches > 0) point.e_m = count.mean_distance_m();
  });
  return curve;
}

constexpr std::size_t kMostBlocks = 20;

// Of sweeps: long enough for what sways slowly, short enough to be several.
std::size_t block_length(std::size_t sweeps) {
  constexpr std::size_t kLength = 8, kLeastLength = 3, kBlocks = 6;
  return std::clamp(sweeps / kBlocks, kLeastLength, kLength);
}

}  // namespace

OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t most_sweeps) {
  OffsetProblem part = problem;
  const std::vector<std::size_t> sweep_of = assign_sweeps(part.recording->scans, part.motor.sweeps, offset_s);
  for (std::size_t i = 0; i < part.scan_used.size(); ++i)
    if (sweep_of[i] != kNoSweep && sweep_of[i] >= most_sweeps) part.scan_used[i] = 0;
  return part;
}

std::optional<double> sigma_of_roll(const std::vector<double>& sweep_roll_rad) {
  return block_sigma(sweep_roll_rad, block_length(sweep_roll_rad.size()), kMostBlocks);
}

MovingPass moving_pass(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                       const Job& job) {
  MovingPass pass;
  pass.offset_s = offset_s;
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  const auto walk = track(problem, offset_s, options, job);
  if (!walk || walk->lost) return pass;
  AlternatingRoll roll = take_out_alternating_roll(walk->sweeps, axis, options.settling_sweeps);
  pass.tracked = !roll.sweep_s.empty();
  pass.roll_rad = roll.signed_rotation_rad;
  pass.sweep_s = std::move(roll.sweep_s);
  pass.sweep_roll_rad = std::move(roll.sweep_roll_rad);
  pass.sweeps = std::move(roll.sweeps);
  return pass;
}

double alternating_sway_rad(const std::vector<SweepPose>& sweeps, const Eigen::Vector3d& motor_axis) {
  using Eigen::Vector3d;
  std::vector<Vector3d> to_next_rad(sweeps.size(), Vector3d::Zero()), within_rad(sweeps.size());
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    within_rad[k] = vector_from_rotation(sweeps[k].begin.rotation.conjugate() * sweeps[k].end.rotation);
    if (k > 0)
      to_next_rad[k] =
          vector_from_rotation(sweeps[k - 1].middle().rotation.conjugate() * sweeps[k].middle().rotation);
  }
  // [-1 2 -1] / 4 passes nothing of a turn that goes on steadily.
  const auto mean_alternation_rad = [&](const std::vector<Vector3d>& turn_rad) {
    Vector3d sum_rad = Vector3d::Zero();
    double count = 0;
    for (std::size_t k = 2; k + 1 < sweeps.size(); ++k, ++count)
      sum_rad += sweeps[k].direction * (2 * turn_rad[k] - turn_rad[k - 1] - turn_rad[k + 1]) / 4;
    return Vector3d(sum_rad / std::max(1.0, count));
  };
  const Vector3d middles_rad = mean_alternation_rad(to_next_rad);
  const Vector3d across_rad = middles_rad - motor_axis.dot(middles_rad) * motor_axis;
  return std::hypot(across_rad.norm(), mean_alternation_rad(within_rad).norm());
}

MovingDirect solve_moving(const OffsetProblem& problem, double first_offset_s,
                          const MovingDirectOptions& options, const Job& job) {
  MovingDirect result;
  result.roll_offset_s = first_offset_s;
  const double nominal_rad_s = 2 * problem.motor.median_speed_rad_s;
  bool near = false;
  for (int i = 0; i < options.most_passes && !near; ++i) {
    result.passes.push_back(moving_pass(problem, result.roll_offset_s, options.mapping, job));
    const MovingPass& pass = result.passes.back();
    result.lost = !pass.tracked;
    if (result.lost || job.cancelled()) return result;
    const double step_s = -pass.roll_rad / nominal_rad_s;
    result.roll_offset_s += std::clamp(step_s, -options.most_step_s, options.most_step_s);
    near = std::abs(step_s) < options.step_tolerance_s;
  }
  const MovingPass& last = result.passes.back();
  result.joint = solve_joint_walk(problem, last.sweeps, last.offset_s, options.joint, job);
  if (!result.joint) return result;
  result.converged = near && result.joint->converged;
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  result.sway_rad = alternating_sway_rad(result.joint->sweeps, axis);
  result.curve = sides(problem, *result.joint, options);
  return result;
}

}  // namespace sweepscope
