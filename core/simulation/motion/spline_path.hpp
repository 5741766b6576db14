#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/simulation/motion/trajectory.hpp"

namespace sweepscope::simulation {

/// A smooth motion through recorded poses, which come at 20 to 200 Hz with jitter: a cubic B-spline with
/// equal knots, fitted by least squares. Position and orientation are twice continuously differentiable. The
/// orientation's spline runs over the quaternion's four numbers, their signs made continuous, and is
/// normalised on reading.
class SplinePath {
 public:
  /// The poses' times must be strictly ascending, and neighbours must differ by less than 180 deg. Gaps of
  /// several knots are bridged with little bending. Throws std::invalid_argument for fewer than two poses.
  SplinePath(std::span<const StampedPose> poses, double knots_s);

  /// Before the first pose and after the last one it rests.
  Pose at(double time_s) const;

  /// The time of the first pose, and the end of the last interval.
  double first_s() const { return first_s_; }
  /// See first_s.
  double last_s() const { return first_s_ + knot_s_ * static_cast<double>(intervals_); }

 private:
  static constexpr int kColumns = 7;  // x y z qx qy qz qw
  using Row = Eigen::Matrix<double, 1, kColumns>;
  struct Place {
    std::size_t interval;  // the first of the four coefficients that count here
    double weights[4];
  };
  Place place(double time_s) const;

  double first_s_ = 0, knot_s_ = 0;
  std::size_t intervals_ = 0;
  std::vector<Row> coefficients_;
};

/// The root mean square deviation of a spline from the poses that it was fitted to.
struct SplineDeviation {
  double position_m = 0, rotation_rad = 0;  // of distances and of angles
};

/// That of a spline from these poses.
SplineDeviation deviation(const SplinePath& path, std::span<const StampedPose> poses);

}  // namespace sweepscope::simulation
