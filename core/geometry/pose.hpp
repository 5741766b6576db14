#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/numbers.hpp"

namespace sweepscope {

/// The six unknowns of a motion.
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A rigid transform: p_in_a = a_from_b * p_in_b.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // of b's axes in a
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();       // of b's origin in a

  /// p_in_a of p_in_b.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation_m; }
  /// a_from_b * b_from_c is a_from_c.
  Pose operator*(const Pose& other) const {
    return {(rotation * other.rotation).normalized(), *this * other.translation_m};
  }
  /// b_from_a.
  Pose inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * translation_m)};
  }
};

/// The pose of the rig's base frame in the map frame at a time of the laser's clock.
struct StampedPose {
  double time_s = 0;                                                // seconds since Recording::epoch_ns
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();             // of the base frame's origin
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // map_from_base
};

/// The rotation vector's quaternion: axis times angle (rad).
inline Eigen::Quaterniond rotation_from_vector(const Eigen::Vector3d& rotation_rad) {
  const double angle_rad = rotation_rad.norm();
  if (angle_rad < 1e-12)
    return Eigen::Quaterniond(1, rotation_rad.x() / 2, rotation_rad.y() / 2, rotation_rad.z() / 2);
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, rotation_rad / angle_rad));
}

/// The rotation vector of a quaternion: axis times angle (rad), angle in [0, pi].
inline Eigen::Vector3d vector_from_rotation(const Eigen::Quaterniond& rotation) {
  const double sine = rotation.vec().norm();
  if (sine < 1e-12) return 2.0 * (rotation.w() < 0 ? -1.0 : 1.0) * rotation.vec();
  const double angle_rad = 2.0 * std::atan2(rotation.w() < 0 ? -sine : sine, std::abs(rotation.w()));
  return angle_rad / sine * rotation.vec();
}

/// Rz(yaw) Ry(pitch) Rx(roll) of an `rpy_deg`, the convention of rig files and ROS.
inline Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& rpy_deg) {
  const Eigen::Vector3d rpy_rad = rpy_deg * kRadPerDeg;
  return Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
}

/// The rotation vector from `from` to `to`, in the axes of `from`.
inline Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return vector_from_rotation(from.conjugate() * to);
}

/// Interpolates between `from` (u = 0) and `to` (u = 1): linear translation, rotation at constant rate. A u
/// outside [0, 1] extrapolates.
inline Pose interpolate(const Pose& from, const Pose& to, double u) {
  const Eigen::Vector3d turn_rad = turn_between(from.rotation, to.rotation);
  return {from.rotation * rotation_from_vector(u * turn_rad),
          from.translation_m + u * (to.translation_m - from.translation_m)};
}

}  // namespace sweepscope
