#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/loam/guided_path.hpp"
#include "core/offset/scan_equations.hpp"

namespace sweepscope {

/// The factor of the matrix of a walk's normal equations.
class WalkFactor {
 public:
  /// Absent where `matrix`, of which the lower triangle is used, is not positive definite.
  static std::optional<WalkFactor> of(Eigen::MatrixXd matrix);

  /// The inverse of the matrix times each column.
  Eigen::MatrixXd solved(Eigen::MatrixXd columns) const;
  /// The inverse of the matrix times the unit vector of an unknown: how the gradient acts on it.
  Eigen::VectorXd influence(std::size_t unknown) const;
  std::size_t unknowns() const { return std::size_t(lower_.rows()); }
  /// Of the last unknown.
  double offset_sigma_s() const { return 1 / lower_(lower_.rows() - 1, lower_.rows() - 1); }

 private:
  explicit WalkFactor(Eigen::MatrixXd lower) : lower_(std::move(lower)) {}

  Eigen::MatrixXd lower_;
};

/// Normal equations of a part of a walk: the path's blocks of six unknowns, and the offset last. Only the
/// lower triangle.
class WalkEquations {
 public:
  WalkEquations(std::size_t blocks, Summed summed);

  /// The matches, of scans whose poses depend on the knots, and on a given motion's time shift, by `motions`.
  /// The scans' equations must hold what these sum up.
  void add(const ScanEquations& scans, const std::vector<ScanMotion>& motions, const GuidedPath& path);
  /// The acceleration of the walk, or of its deviation from a given motion, changes little: third differences
  /// of the knots are near zero, to within sigma (rotation, translation).
  void add_jerks(const GuidedPath& path, const Eigen::Vector2d& sigma);
  /// A map can be moved as a whole where there are knots, and a knot that sees little stays where it is.
  void hold(std::size_t knots, double first_sigma, double knot_sigma, double offset_sigma_s);

  /// Of half the sum of the squares, by the unknowns.
  const Eigen::VectorXd& gradient() const { return gradient_; }

  /// Once: gives its matrix away, of equations that sum up all.
  std::optional<WalkFactor> factorise() { return WalkFactor::of(std::move(matrix_)); }

  struct Step {
    std::vector<Vector6d> of_blocks;
    double of_offset_s;
  };
  Step step(const WalkFactor& factor) const;

 private:
  void add_gradient(const ScanEquations& scans, const std::vector<ScanMotion>& motions,
                    const GuidedPath& path);
  void add_matrix(const ScanEquations& scans, const std::vector<ScanMotion>& motions, const GuidedPath& path);
  void add_block(std::size_t row, std::size_t column, const Matrix6d& half);

  Summed summed_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gradient_;
};

/// How something changes with a scan's pose, from how it changes with all unknowns, six each.
Vector6d by_pose(const Eigen::VectorXd& by_unknowns, const ScanMotion& motion, const GuidedPath& path);

}  // namespace sweepscope
