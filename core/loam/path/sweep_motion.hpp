#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"

namespace sweepscope {

/// The poses between two: linear translation, rotation at constant rate.
class MotionStep {
 public:
  /// The motion between two poses: a constant rotation rate and a straight line.
  MotionStep(const Pose& begin, const Pose& end)
      : begin_m_(begin.translation_m),
        turn_rad_(turn_between(begin.rotation, end.rotation)),
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
    return rotation_ * turned_m + begin_m_ + u * shift_m_;
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

  Eigen::Vector3d begin_m_, turn_rad_, shift_m_;
  Eigen::Matrix3d rotation_;
  double turn_rad2_;
};

/// The pose at u between knots at equal steps from 0 to 1; beyond them the motion continues.
inline Pose pose_between(std::span<const Pose> knots, double u) {
  const double place = u * double(knots.size() - 1);
  const auto i = std::size_t(std::clamp(place, 0.0, double(knots.size() - 2)));
  return interpolate(knots[i], knots[i + 1], place - double(i));
}

/// The poses within a sweep, or its first part: knots at equal steps of u from its begin (0) to `end_u`;
/// between two knots the translation is linear and the rotation at constant rate, and beyond them the motion
/// continues. What all points of a step share is computed once.
class SweepMotion {
 public:
  /// Knots at equal distances over the sweep; the last one is at `end_u` of it.
  explicit SweepMotion(std::span<const Pose> knots, double end_u = 1)
      : steps_per_u_(double(knots.size() - 1) / end_u), last_(double(knots.size() - 2)) {
    steps_.reserve(knots.size() - 1);
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) steps_.emplace_back(knots[i], knots[i + 1]);
  }

  /// Where a point of the base frame is in the map frame at u.
  Eigen::Vector3d operator()(const Eigen::Vector3d& p_in_base_m, double u) const {
    const double place = u * steps_per_u_;
    const auto i = std::size_t(std::clamp(place, 0.0, last_));
    return steps_[i](p_in_base_m, place - double(i));
  }

 private:
  std::vector<MotionStep> steps_;
  double steps_per_u_, last_;
};

}  // namespace sweepscope
