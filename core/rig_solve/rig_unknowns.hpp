#pragma once

// The mathematics: docs/rig.md.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/geometry/gear.hpp"

namespace sweepscope {

/// The places of the unknowns in a step, a Jacobian's row and a covariance.
enum RigUnknown : int { kOffset, kTurnU, kTurnV, kShiftU, kShiftV, kPlay, kEncoderSine, kEncoderCosine };
/// Offset, two angles and two shifts of the mount, play, and two terms of the encoder.
inline constexpr int kRigUnknowns = 8;
/// The unknowns in the order of RigUnknown, in s, rad and m.
using RigVector = Eigen::Matrix<double, kRigUnknowns, 1>;
/// A normal matrix or covariance of them.
using RigMatrix = Eigen::Matrix<double, kRigUnknowns, kRigUnknowns>;

/// The offset and the deviations of a rig from its rig file.
///
/// The pose of the laser in the frame that turns with the motor is R' = exp(turn) R, t' = t + shift, with R
/// and t from the rig file. Turn and shift are perpendicular to the motor's axis; along it they are
/// unobservable. The laser's angle is phi - a sin(phi) - b cos(phi) - s play / 2, phi the encoder's angle, s
/// = +1 where it grows and -1 where it falls.
struct RigUnknowns {
  double offset_s = 0;                                    // t_motor = t_laser + offset
  Eigen::Vector2d turn_rad = Eigen::Vector2d::Zero();     // rotation vector, along the axes of `AxisFrame`
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();      // along the same axes
  double play_rad = 0;                                    // of the gear, from one side to the other
  Eigen::Vector2d encoder_rad = Eigen::Vector2d::Zero();  // a and b; see Gear
  // Of recordings with an offset each: what is added to offset_s for each of them. Empty: offset_s is that of
  // all.
  std::vector<double> apart_s = {};

  /// The same with the offset of one of the recordings.
  RigUnknowns of_recording(std::size_t i) const {
    RigUnknowns of_it = *this;
    if (!apart_s.empty()) of_it.offset_s += apart_s[i];
    of_it.apart_s.clear();
    return of_it;
  }
  /// The part that changes the motor angle.
  Gear gear() const { return {play_rad, encoder_rad}; }
  /// The unknowns of all recordings in the order of RigUnknown, without `apart_s`.
  RigVector vector() const {
    RigVector x;
    x << offset_s, turn_rad, shift_m, play_rad, encoder_rad;
    return x;
  }
  /// The inverse of `vector`.
  static RigUnknowns from(const RigVector& x) {
    return {x[kOffset], x.segment<2>(kTurnU),       x.segment<2>(kShiftU),
            x[kPlay],   x.segment<2>(kEncoderSine), {}};
  }
};

/// Two directions perpendicular to the motor's axis and to each other: the columns.
Eigen::Matrix<double, 3, 2> across_axis(const Eigen::Vector3d& axis);

/// The mount with the turn and the shift of the unknowns. A turn about the motor's axis has no effect but to
/// turn the base frame: where the axis is x, y or z, it is chosen so that the mount's roll, pitch or yaw
/// stays what it was.
Mount changed(const Mount& mount, const RigUnknowns& unknowns);

/// Places the points of beams in the base frame.
class RigGeometry {
 public:
  /// The mount as given, changed by the unknowns.
  RigGeometry(const Mount& mount, const RigUnknowns& unknowns);

  /// The motor at an instant, by its encoder.
  struct Instant {
    double angle_rad = 0, speed_rad_s = 0;  // of the motor at the instant of the beam
    int direction = 0;                      // in which the motor turns, 1 or -1
  };
  /// A beam in the frame of the base.
  struct Placed {
    Eigen::Vector3d p_in_base_m;                      // where it ends
    Eigen::Matrix<double, 3, kRigUnknowns> jacobian;  // of the point by the unknowns
  };
  /// `p_in_motor_m` is computed with the rig file's mount.
  Placed place(const Eigen::Vector3d& p_in_motor_m, const Instant& at) const;

 private:
  RigUnknowns unknowns_;
  Eigen::Vector3d axis_, laser_m_;  // of the rig file's mount
  Eigen::Matrix<double, 3, 2> across_, turn_per_unknown_;
  Eigen::Matrix3d turn_;
};

}  // namespace sweepscope
