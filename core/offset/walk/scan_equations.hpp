#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/loam/feature_map.hpp"
#include "core/loam/path/guided_path.hpp"
#include "core/loam/path/least_squares.hpp"

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

/// Steps of all scans' poses and of the offset, or a derivative by them.
struct ByScan {
  std::vector<Vector6d> scans;
  double offset = 0;
};

/// The matches, and their normal equations for the steps of all scans' poses and of the offset. Points of one
/// scan depend on the walk's knots in the same way: with sums by scan first, a match costs a tenth of what it
/// would knot by knot.
class ScanEquations {
 public:
  explicit ScanEquations(std::size_t scans) : scans_(scans) {}

  void add(const ScanRow& row, double offset_slope, double residual, double weight);

  struct Match {
    double residual, weight, offset_slope;
    std::size_t first_row;
  };
  const std::vector<Match>& matches() const { return matches_; }
  /// How the residual of each match changes along steps.
  std::vector<double> changes(const ByScan& steps) const;

  /// Of half the weighted sum of the squares.
  ByScan gradient() const;
  /// The normal matrix times steps, match by match: without the matrix, which takes longer to sum up than
  /// many products.
  ByScan product(const ByScan& steps) const;

  /// A part of the normal matrix: the sum over the matches of this scan's row (upright) times that of scan
  /// `other`, which is not after it.
  struct Product {
    std::uint32_t other;
    Matrix6d sum;
  };
  struct Scan {
    std::vector<Product> products;
    std::vector<std::uint32_t> places;  // of the products, hashed by the other scan: there are hundreds
    Vector6d with_offset = Vector6d::Zero();
  };
  struct Matrix {
    std::vector<Scan> scans;
    double offset_square = 0;
  };
  Matrix matrix() const;
  /// Its diagonal: each scan's product with itself, and that of the offset.
  struct Diagonal {
    std::vector<Matrix6d> scans;
    double offset_square = 0;
  };
  Diagonal diagonal() const;

 private:
  std::size_t end_row(std::size_t match) const;
  double change(std::size_t match, const ByScan& steps) const;
  void add_row(std::size_t match, double factor, ByScan& sum) const;

  std::size_t scans_;
  std::vector<Match> matches_;
  // All matches' rows, one after another, and the scans whose poses they are for.
  std::vector<Vector6d> rows_;
  std::vector<std::uint32_t> scan_of_row_;
};

}  // namespace sweepscope
