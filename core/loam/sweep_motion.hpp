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
        turn_rad2_(turn_rad_.squaredNorm()) {}

  /// Where a point of the base frame is in the map frame at u: 0 at the begin, 1 at the end.
  Eigen::Vector3d operator()(const Eigen::Vector3d& p_in_base_m, double u) const {
    // Rodrigues' formula: p + sin(a) / a (w x p) + (1 - cos(a)) / a^2 (w x (w x p)), w the turn up to u.
    const auto [sine, cosine] = turn_factors(u * u * turn_rad2_);
    const Eigen::Vector3d across_m = turn_rad_.cross(p_in_base_m);
    const Eigen::Vector3d turned_m =
        p_in_base_m + (sine * u) * across_m + (cosine * u * u) * turn_rad_.cross(across_m);
    const Eigen::Vector3d p_m = rotation_ * turned_m + begin_.translation_m + u * shift_m_;
    const Eigen::Vector3d turn_rad = bend_.head<3>();  // small: to first order
    return p_m + bend_at(u) * (turn_rad.cross(p_m - pivot_m_) + bend_.tail<3>());
  }

 private:
  struct TurnFactors {
    double sine, cosine;  // sin(a) / a and (1 - cos(a)) / a^2
  };
  // Of a squared angle. A sweep's is mostly small: its series ends after a few terms, with all digits.
  static TurnFactors turn_factors(double x) {
    if (x > 0.25) {
      const double angle_rad = std::sqrt(x);
      return {std::sin(angle_rad) / angle_rad, (1 - std::cos(angle_rad)) / x};
    }
    return {
        1 - x * (1.0 / 6) *
                (1 - x * (1.0 / 20) *
                         (1 - x * (1.0 / 42) *
                                  (1 - x * (1.0 / 72) * (1 - x * (1.0 / 110) * (1 - x * (1.0 / 156)))))),
        (1 - x * (1.0 / 12) *
                 (1 - x * (1.0 / 30) *
                          (1 - x * (1.0 / 56) *
                                   (1 - x * (1.0 / 90) * (1 - x * (1.0 / 132) * (1 - x * (1.0 / 182))))))) /
            2};
  }

  Pose begin_;
  Vector6d bend_;
  Eigen::Vector3d pivot_m_;
  Eigen::Vector3d turn_rad_, shift_m_;
  Eigen::Matrix3d rotation_;
  double turn_rad2_;
};

}  // namespace sweepscope
