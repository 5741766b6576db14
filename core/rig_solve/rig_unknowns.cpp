#include "core/rig_solve/rig_unknowns.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// exp(v + dv) = exp(J dv) exp(v) for a small dv.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  const Eigen::Matrix3d k = cross_matrix(v);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() + 0.5 * k;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * k +
         (angle - std::sin(angle)) / (angle * angle * angle) * k * k;
}

// The inverse of rotation_from_rpy.
Eigen::Vector3d rpy_deg_of(const Eigen::Matrix3d& r) {
  const double pitch_rad = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  return Eigen::Vector3d(std::atan2(r(2, 1), r(2, 2)), pitch_rad, std::atan2(r(1, 0), r(0, 0))) * kDegPerRad;
}

// The turn about the motor's axis that restores the mount's angle about it; 0 if there is none.
double gauge_rad(const Eigen::Vector3d& axis, const Eigen::Matrix3d& rotation, double kept_deg) {
  constexpr int kSteps = 20;           // a bound
  constexpr double kDone_deg = 1e-10;  // rounding errors
  int i = 0;
  if (axis.cwiseAbs().maxCoeff(&i) < 1 - 1e-9) return 0;
  double turn_rad = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double off_deg =
        rpy_deg_of(Eigen::AngleAxisd(turn_rad, axis).toRotationMatrix() * rotation)[i] - kept_deg;
    if (std::abs(off_deg) < kDone_deg) return turn_rad;
    turn_rad -= axis[i] * off_deg * kRadPerDeg;
  }
  return 0;
}

}  // namespace

Eigen::Matrix<double, 3, 2> across_axis(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d a = axis.normalized();
  int smallest = 0;
  a.cwiseAbs().minCoeff(&smallest);
  // Of two equal components the later: y and z for the x axis.
  for (int i = smallest + 1; i < 3; ++i)
    if (std::abs(a[i]) <= std::abs(a[smallest])) smallest = i;
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = Eigen::Vector3d::Unit(smallest).cross(a).normalized();
  across.col(1) = a.cross(across.col(0));
  return across;
}

Mount changed(const Mount& mount, const RigUnknowns& unknowns) {
  const Eigen::Matrix<double, 3, 2> across = across_axis(mount.axis);
  Mount result = mount;
  result.laser_in_motor_xyz_m += across * unknowns.shift_m;
  if (unknowns.turn_rad.isZero(0)) return result;
  const Eigen::Vector3d axis = mount.axis.normalized();
  const Eigen::Matrix3d turned =
      (rotation_from_vector(across * unknowns.turn_rad) * rotation_from_rpy(mount.laser_in_motor_rpy_deg))
          .toRotationMatrix();
  int along = 0;
  axis.cwiseAbs().maxCoeff(&along);
  const Eigen::Matrix3d gauge =
      Eigen::AngleAxisd(gauge_rad(axis, turned, mount.laser_in_motor_rpy_deg[along]), axis)
          .toRotationMatrix();
  result.laser_in_motor_rpy_deg = rpy_deg_of(gauge * turned);
  double& kept_deg = result.laser_in_motor_rpy_deg[along];
  if (std::abs(kept_deg - mount.laser_in_motor_rpy_deg[along]) < 1e-9)
    kept_deg = mount.laser_in_motor_rpy_deg[along];  // free of rounding errors
  result.laser_in_motor_xyz_m = gauge * result.laser_in_motor_xyz_m;
  return result;
}

RigGeometry::RigGeometry(const Mount& mount, const RigUnknowns& unknowns)
    : unknowns_(unknowns),
      axis_(mount.axis.normalized()),
      laser_m_(mount.laser_in_motor_xyz_m),
      across_(across_axis(mount.axis)),
      turn_per_unknown_(left_jacobian(across_ * unknowns.turn_rad) * across_),
      turn_(rotation_from_vector(across_ * unknowns.turn_rad).toRotationMatrix()) {}

RigGeometry::Placed RigGeometry::place(const Eigen::Vector3d& p_in_motor_m, const Instant& at) const {
  const double sine = std::sin(at.angle_rad), cosine = std::cos(at.angle_rad);
  const Eigen::Vector2d& e = unknowns_.encoder_rad;
  const double laser_angle_rad =
      at.angle_rad - e[0] * sine - e[1] * cosine - at.direction * unknowns_.play_rad / 2;
  const double per_encoder = 1 - e[0] * cosine + e[1] * sine;
  const Eigen::Matrix3d roll = Eigen::AngleAxisd(laser_angle_rad, axis_).toRotationMatrix();
  const Eigen::Vector3d turned_m = turn_ * (p_in_motor_m - laser_m_);
  Placed placed;
  placed.p_in_base_m = roll * (turned_m + laser_m_ + across_ * unknowns_.shift_m);
  const Eigen::Vector3d per_angle_m = axis_.cross(placed.p_in_base_m);
  placed.jacobian.col(kOffset) = at.speed_rad_s * per_encoder * per_angle_m;
  for (int i = 0; i < 2; ++i)
    placed.jacobian.col(kTurnU + i) = roll * turn_per_unknown_.col(i).cross(turned_m);
  placed.jacobian.middleCols<2>(kShiftU) = roll * across_;
  placed.jacobian.col(kPlay) = -0.5 * at.direction * per_angle_m;
  placed.jacobian.col(kEncoderSine) = -sine * per_angle_m;
  placed.jacobian.col(kEncoderCosine) = -cosine * per_angle_m;
  return placed;
}

}  // namespace sweepscope
