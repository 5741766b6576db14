#include "core/loam/path/sweep_pose.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/path_equations.hpp"

namespace sweepscope {

std::vector<Vector6d> twists_per_s(const SweepPose& pose, std::size_t parts) {
  const double n = double(parts), part_s = (pose.end_s - pose.begin_s) / n;
  std::vector<Vector6d> twists;
  for (std::size_t i = 0; i < parts; ++i)
    twists.push_back(difference(pose.at(double(i + 1) / n), pose.at(double(i) / n)) / part_s);
  return twists;
}

Eigen::Vector2d jerk(std::span<const SweepPose> sweeps, std::size_t parts_of_sweep) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Vector6d last_twist_per_s = Vector6d::Zero(), last_change_per_s2 = Vector6d::Zero();
  std::size_t count = 0;
  for (const SweepPose& sweep : sweeps) {
    const double part_s = (sweep.end_s - sweep.begin_s) / double(parts_of_sweep);
    for (const Vector6d& twist_per_s : twists_per_s(sweep, parts_of_sweep)) {
      const Vector6d change_per_s2 = (twist_per_s - last_twist_per_s) / part_s;
      const Vector6d jerk_per_s3 = (change_per_s2 - last_change_per_s2) / part_s;
      last_twist_per_s = twist_per_s;
      last_change_per_s2 = change_per_s2;
      if (++count > 2)
        sum += Eigen::Vector2d(jerk_per_s3.head<3>().squaredNorm(), jerk_per_s3.tail<3>().squaredNorm()) / 3;
    }
  }
  return count > 2 ? Eigen::Vector2d((sum / double(count - 2)).cwiseSqrt()) : Eigen::Vector2d(sum);
}

double alternating_sway_rad(std::span<const SweepPose> sweeps, const Eigen::Vector3d& motor_axis) {
  using Eigen::Vector3d;
  std::vector<Vector3d> to_next_rad(sweeps.size(), Vector3d::Zero()), within_rad(sweeps.size());
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    within_rad[k] = turn_between(sweeps[k].begin().rotation, sweeps[k].end().rotation);
    if (k > 0) to_next_rad[k] = turn_between(sweeps[k - 1].middle().rotation, sweeps[k].middle().rotation);
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

}  // namespace sweepscope
