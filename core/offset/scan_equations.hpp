#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/loam/feature_map.hpp"
#include "core/loam/guided_path.hpp"
#include "core/loam/least_squares.hpp"

namespace sweepscope {

/// What the points of a scan, or of a slice of one, share: where the motor's axis was, how fast it turned,
/// and between which knots.
struct ScanMotion {
  GuidedPath::Place place;
  Eigen::Vector3d base_in_map_m, turning_rad_s;
};

/// How a distance changes with the poses of the scans (or slices) that its points were measured in: its own
/// point's, and those of the neighbours that its surface was fitted to.
class ScanRow {
 public:
  void clear() { count_ = 0; }
  /// Adds one point at `p_m` of scan number `scan`, times `share`, along `normal`. Gives how the point's
  /// distance changes with the offset, times `share`.
  double add_point(std::uint32_t scan, const ScanMotion& motion, const Eigen::Vector3d& p_m,
                   const Eigen::Vector3d& normal, double share);
  std::size_t size() const { return count_; }
  std::uint32_t scan(std::size_t i) const { return scans_[i]; }
  const Vector6d& row(std::size_t i) const { return rows_[i]; }

 private:
  static constexpr std::size_t kMax = 1 + Neighbours::kMax;
  std::size_t count_ = 0;
  std::array<std::uint32_t, kMax> scans_;
  std::array<Vector6d, kMax> rows_;
};

/// Normal equations of the steps of all scans' poses, and of the offset. Points of one scan depend on the
/// walk's knots alike: summed up here first, a match costs a tenth of what it would knot by knot.
class ScanEquations {
 public:
  explicit ScanEquations(std::size_t scans) : scans_(scans) {}

  void add(const ScanRow& row, double offset_slope, double residual, double weight);

  /// The sum over the matches of this scan's row (upright) times that of scan `other`, which is not after it.
  struct Product {
    std::uint32_t other;
    Matrix6d sum;
  };
  struct Scan {
    std::vector<Product> products;
    std::vector<std::uint32_t> places;  // of the products, hashed by the other scan: there are hundreds
    Vector6d gradient = Vector6d::Zero(), with_offset = Vector6d::Zero();
  };
  const std::vector<Scan>& scans() const { return scans_; }
  double offset_gradient() const { return offset_gradient_; }
  double offset_square() const { return offset_square_; }

 private:
  std::vector<Scan> scans_;
  double offset_gradient_ = 0, offset_square_ = 0;
};

}  // namespace sweepscope
