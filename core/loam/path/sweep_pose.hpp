#pragma once

// The mathematics: docs/algorithms.md, section 6.2.

#include <cstddef>
#include <span>
#include <vector>

#include "core/loam/path/sweep_motion.hpp"

namespace sweepscope {

/// Where the base frame was during a sweep (map_from_base): knots at equal times from its begin to its end,
/// at least two. Between knots the translation goes linearly and the rotation at constant rate.
struct SweepPose {
  std::size_t sweep = 0;                  // index into MotorMotion::sweeps
  int direction = 0;                      // in which the motor turns, 1 or -1
  double begin_s = 0, end_s = 0;          // laser clock
  std::vector<Pose> knots{2};             // map_from_base at equal distances in time, first to last beam
  std::size_t features = 0, matches = 0;  // of the sweep; those matched to the map
  bool lost = false;                      // too few features matched the map: the pose is a guess
  std::size_t stretch = 0;                // sweeps of one stretch lie on one map; 0: not tracked

  /// map_from_base at the first beam.
  const Pose& begin() const { return knots.front(); }
  /// map_from_base at the last beam.
  const Pose& end() const { return knots.back(); }
  /// map_from_base at a fraction of the sweep: 0 the first beam, 1 the last.
  Pose at(double u) const { return pose_between(knots, u); }
  /// map_from_base half way in time.
  Pose middle() const { return at(0.5); }
  /// The motion in the sweep, to place many beams.
  SweepMotion motion() const { return SweepMotion(knots); }
};

/// The velocities of a sweep's parts, equally long (rotation vector in rad/s, translation in m/s; map frame).
std::vector<Vector6d> twists_per_s(const SweepPose& pose, std::size_t parts);

/// Root mean square of how fast the acceleration changes, of a component of the rotation (rad/s^3) and of the
/// translation (m/s^3), from the mean velocities of so many parts of every sweep; 0 if there are too few.
Eigen::Vector2d jerk(std::span<const SweepPose> sweeps, std::size_t parts_of_sweep);

/// The rotation (rad) by which a body that sways in step with the motor turns from one sweep to the next. It
/// is found from motion that an offset error cannot cause, which turns whole sweeps about the motor's axis:
/// the turns of the middles about the axes across it, and the turns within the sweeps.
double alternating_sway_rad(std::span<const SweepPose> sweeps, const Eigen::Vector3d& motor_axis);

}  // namespace sweepscope
