#include "core/simulation/motion/spline_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace sweepscope::simulation {
namespace {

// The square of a second difference weighs this much beside the squares of a knot's share of the poses. It
// decides where poses are missing; with knots of 50 ms it takes 0.3 % of a motion of 5 Hz away, and of one of
// 1 Hz nothing that counts.
constexpr double kBendWeight = 1e-3;

/// A symmetric matrix with three diagonals below its own, by rows: entry (i, i - k) is rows[i][k].
using Band = std::vector<std::array<double, 4>>;

void add_bending(Band& band, double weight) {
  constexpr double kSecond[3] = {1, -2, 1};
  for (std::size_t first = 0; first + 2 < band.size(); ++first)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j <= i; ++j) band[first + i][i - j] += weight * kSecond[i] * kSecond[j];
}

/// In place: the matrix becomes its Cholesky factor.
void factorize(Band& band) {
  for (std::size_t i = 0; i < band.size(); ++i) {
    for (std::size_t k = std::min<std::size_t>(i, 3); k > 0; --k) {
      const std::size_t j = i - k;
      double sum = band[i][k];
      for (std::size_t m = k + 1; m <= std::min<std::size_t>(i, 3); ++m)
        if (m - k <= 3) sum -= band[i][m] * band[j][m - k];
      band[i][k] = sum / band[j][0];
    }
    double square = band[i][0];
    for (std::size_t k = 1; k <= std::min<std::size_t>(i, 3); ++k) square -= band[i][k] * band[i][k];
    band[i][0] = std::sqrt(square);
  }
}

template <typename Row>
void solve(const Band& factor, std::vector<Row>& right) {
  const std::size_t n = factor.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 1; k <= std::min<std::size_t>(i, 3); ++k) right[i] -= factor[i][k] * right[i - k];
    right[i] /= factor[i][0];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = 1; k <= 3 && i + k < n; ++k) right[i] -= factor[i + k][k] * right[i + k];
    right[i] /= factor[i][0];
  }
}

}  // namespace

SplinePath::Place SplinePath::place(double time_s) const {
  const double knots = std::clamp((time_s - first_s_) / knot_s_, 0.0, static_cast<double>(intervals_));
  const std::size_t interval = std::min(static_cast<std::size_t>(knots), intervals_ - 1);
  const double u = knots - static_cast<double>(interval), v = 1 - u;
  return {interval,
          {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6,
           u * u * u / 6}};
}

SplinePath::SplinePath(std::span<const StampedPose> poses, double knots_s) {
  if (poses.size() < 2) throw std::invalid_argument("a path needs two poses");
  first_s_ = poses.front().time_s;
  const double length_s = poses.back().time_s - first_s_;
  intervals_ = static_cast<std::size_t>(std::max(1.0, std::ceil(length_s / knots_s - 1e-6)));
  knot_s_ = length_s / static_cast<double>(intervals_);

  Band band(intervals_ + 3, {0, 0, 0, 0});
  coefficients_.assign(intervals_ + 3, Row::Zero());
  Eigen::Quaterniond before = poses.front().orientation;
  for (const StampedPose& pose : poses) {
    Eigen::Quaterniond q = pose.orientation;
    if (q.dot(before) < 0) q.coeffs() = -q.coeffs();
    before = q;
    Row row;
    row << pose.position_m.transpose(), q.coeffs().transpose();
    const Place at = place(pose.time_s);
    for (std::size_t i = 0; i < 4; ++i) {
      coefficients_[at.interval + i] += at.weights[i] * row;
      for (std::size_t j = 0; j <= i; ++j) band[at.interval + i][i - j] += at.weights[i] * at.weights[j];
    }
  }
  add_bending(band, kBendWeight * static_cast<double>(poses.size()) / static_cast<double>(intervals_));
  factorize(band);
  solve(band, coefficients_);
}

Pose SplinePath::at(double time_s) const {
  const Place here = place(time_s);
  Row row = Row::Zero();
  for (std::size_t i = 0; i < 4; ++i) row += here.weights[i] * coefficients_[here.interval + i];
  Eigen::Quaterniond q;
  q.coeffs() = row.tail<4>().transpose();
  return {row.head<3>().transpose(), q.normalized()};
}

SplineDeviation deviation(const SplinePath& path, std::span<const StampedPose> poses) {
  double position_m2 = 0, rotation_rad2 = 0;
  for (const StampedPose& pose : poses) {
    const Pose fitted = path.at(pose.time_s);
    position_m2 += (fitted.position_m - pose.position_m).squaredNorm();
    rotation_rad2 += turn_between(fitted.orientation, pose.orientation).squaredNorm();
  }
  const auto count = static_cast<double>(poses.size());
  return {std::sqrt(position_m2 / count), std::sqrt(rotation_rad2 / count)};
}

}  // namespace sweepscope::simulation
