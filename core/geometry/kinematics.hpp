#pragma once

// The mathematics: docs/algorithms.md, section 2.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/geometry/pose.hpp"

namespace sweepscope {

/// How the laser is mounted on the motor.
struct Mount {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // the motor's axis in the base frame, unit length
  // The laser's pose in the frame that turns with the motor: p_in_motor = R(rpy) * p_in_laser + xyz,
  // R = Rz(yaw) Ry(pitch) Rx(roll).
  Eigen::Vector3d laser_in_motor_xyz_m = Eigen::Vector3d::Zero();
  // See laser_in_motor_xyz_m.
  Eigen::Vector3d laser_in_motor_rpy_deg = Eigen::Vector3d::Zero();
};

/// The rig's kinematics: p_in_base = Rot(axis, motor angle) * (motor_from_laser * p_in_laser). Only the first
/// factor depends on the offset, so points are stored in the motor frame, which turns with the motor.
class Kinematics {
 public:
  /// The axis is normalised.
  explicit Kinematics(const Mount& mount)
      : axis_(mount.axis.normalized()),
        motor_from_laser_{rotation_from_rpy(mount.laser_in_motor_rpy_deg), mount.laser_in_motor_xyz_m} {}

  /// A beam's point in the motor frame. `angle_rad` about the laser's z axis, 0 along its x axis.
  Eigen::Vector3d point_in_motor(double range_m, double angle_rad) const {
    return motor_from_laser_ *
           Eigen::Vector3d(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad), 0.0);
  }
  /// The same for a beam in any direction (unit length, laser frame).
  Eigen::Vector3d point_in_motor(double range_m, const Eigen::Vector3d& direction) const {
    return motor_from_laser_ * Eigen::Vector3d(range_m * direction);
  }
  /// The position in the base frame of a point of the motor frame, at a motor angle.
  Eigen::Vector3d base_from_motor(const Eigen::Vector3d& p_in_motor, double motor_angle_rad) const {
    const double c = std::cos(motor_angle_rad), s = std::sin(motor_angle_rad);
    return c * p_in_motor + s * axis_.cross(p_in_motor) + (1 - c) * axis_.dot(p_in_motor) * axis_;
  }
  /// The distance of a point from the motor's axis: the lever arm of an offset error.
  double distance_to_axis_m(const Eigen::Vector3d& p_in_motor) const {
    return axis_.cross(p_in_motor).norm();
  }
  /// The motor's axis in the base frame, unit length.
  const Eigen::Vector3d& axis() const { return axis_; }
  /// Where the laser is in the motor frame.
  Eigen::Vector3d laser_in_motor_m() const { return motor_from_laser_.translation_m; }

 private:
  Eigen::Vector3d axis_;
  Pose motor_from_laser_;
};

/// The motor's angle over its own clock, linear between samples. Times are strictly ascending.
struct MotorTrack {
  std::vector<double> time_s;     // motor clock, seconds since Recording::epoch_ns
  std::vector<double> angle_rad;  // one for each time

  /// The angle at a time, which must lie within [time_s.front(), time_s.back()].
  double angle_at(double t_s) const;
  /// True if both ends lie within the track and no gap between samples in between is longer than max_gap_s.
  bool covers(double from_s, double to_s, double max_gap_s) const;
};

/// Reads a motor track at mostly ascending times: a step or two from the last position instead of a search.
/// Times outside the track get the angle of the nearest end.
class MotorReader {
 public:
  /// The track must outlive the reader.
  explicit MotorReader(const MotorTrack& track) : track_(&track) {}

  /// The angle in rad.
  double angle_at(double motor_time_s) {
    const auto& times = track_->time_s;
    if (times.size() < 2) return times.empty() ? 0.0 : track_->angle_rad.front();
    while (next_ + 1 < times.size() && times[next_] <= motor_time_s) ++next_;
    while (next_ > 1 && times[next_ - 1] > motor_time_s) --next_;
    const double u =
        std::clamp((motor_time_s - times[next_ - 1]) / (times[next_] - times[next_ - 1]), 0.0, 1.0);
    return track_->angle_rad[next_ - 1] + u * (track_->angle_rad[next_] - track_->angle_rad[next_ - 1]);
  }

 private:
  const MotorTrack* track_;
  std::size_t next_ = 1;
};

/// Reads the motor's mean speed over 10 ms to either side, a sample of an encoder at 100 Hz, at mostly
/// ascending times.
class MotorSpeedReader {
 public:
  /// The track must outlive the reader.
  explicit MotorSpeedReader(const MotorTrack& track) : before_(track), after_(track) {}

  /// The mean speed about a time.
  double speed_rad_s(double motor_time_s) {
    constexpr double kSpan_s = 0.010;
    return (after_.angle_at(motor_time_s + kSpan_s) - before_.angle_at(motor_time_s - kSpan_s)) /
           (2 * kSpan_s);
  }

 private:
  MotorReader before_, after_;
};

}  // namespace sweepscope
