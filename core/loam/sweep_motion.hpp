#pragma once

#include "core/loam/least_squares.hpp"

namespace sweepscope {

/// The poses within a sweep: between its begin and its end the translation goes linearly and the rotation at
/// constant rate, but for a bend (rotation vector about the middle of both places in rad, translation in m;
/// map frame), which acts as 4 u (1 - u): a walker sways within a sweep. What all points share is worked out
/// once.
class SweepMotion {
 public:
  SweepMotion(const Pose& begin, const Pose& end, const Vector6d& bend = Vector6d::Zero())
      : begin_(begin),
        bend_(bend),
        pivot_m_((begin.translation_m + end.translation_m) / 2),
        turn_rad_(vector_from_rotation(begin.rotation.conjugate() * end.rotation)),
        shift_m_(end.translation_m - begin.translation_m),
        rotation_(begin.rotation.toRotationMatrix()),
        turn_angle_rad_(turn_rad_.norm()),
        turn_axis_(turn_angle_rad_ > 1e-12 ? Eigen::Vector3d(turn_rad_ / turn_angle_rad_)
                                           : Eigen::Vector3d::UnitX()) {}

  /// Where a point of the base frame is in the map frame at u: 0 at the begin, 1 at the end.
  Eigen::Vector3d operator()(const Eigen::Vector3d& p_in_base_m, double u) const {
    const double angle_rad = u * turn_angle_rad_;
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const Eigen::Vector3d turned_m = c * p_in_base_m + s * turn_axis_.cross(p_in_base_m) +
                                     (1 - c) * turn_axis_.dot(p_in_base_m) * turn_axis_;
    const Eigen::Vector3d p_m = rotation_ * turned_m + begin_.translation_m + u * shift_m_;
    const Eigen::Vector3d turn_rad = bend_.head<3>();  // small: to first order
    return p_m + bend_at(u) * (turn_rad.cross(p_m - pivot_m_) + bend_.tail<3>());
  }

 private:
  Pose begin_;
  Vector6d bend_;
  Eigen::Vector3d pivot_m_;
  Eigen::Vector3d turn_rad_, shift_m_;
  Eigen::Matrix3d rotation_;
  double turn_angle_rad_;
  Eigen::Vector3d turn_axis_;
};

}  // namespace sweepscope
