#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {

/// The difference of two poses of the map frame: rotation vector (rad), then translation (m).
Vector6d difference(const Pose& to, const Pose& from);

/// Normal equations of the steps of a path's knots (see `stepped`), from points measured between them and
/// from how bodies move. Each knot's step is six unknowns, all about one pivot.
class PathEquations {
 public:
  /// Of knots at equal steps of u from 0 to `end_u`, at least two.
  PathEquations(std::size_t knots, double end_u);

  /// A residual of a point measured at u, whose row J acts as (1 - f) J on the step of the knot before it and
  /// as f J on that of the knot after it, f the part of the way between them.
  void add(double u, const Vector6d& row, double residual, double weight);

  /// The path changes its velocity little: second differences of the knots, of standard deviation `sigma`
  /// (rotation, translation). `before` is the knot before the first one, which stays. With `moves` it is the
  /// velocity's deviation from a given motion that changes little: moves[i] leads to knot i from the one
  /// before it (pose * move), and each difference is taken from there.
  void add_accelerations(std::span<const Pose> knots, const Pose& before, const Eigen::Vector2d& sigma,
                         const Eigen::Vector3d& pivot_m, std::span<const Pose> moves = {});
  /// First differences of the knots are small, with `moves` those from where the given motion leads.
  void add_velocities(std::span<const Pose> knots, double sigma, const Eigen::Vector3d& pivot_m,
                      std::span<const Pose> moves = {});
  /// The first knot is near a given pose.
  void add_tie(const Pose& first_knot, const Pose& given, double sigma, const Eigen::Vector3d& pivot_m);

  /// The steps that minimise the sum of the weighted squares.
  std::vector<Vector6d> solve() const;

  /// J^T W J over all knots, six rows each.
  Eigen::MatrixXd matrix() const;
  /// J^T W r, in the same order.
  Eigen::VectorXd gradient() const { return prior_gradient_ + point_gradient(); }

 private:
  // Sums over the points between two knots, times 1, f and f^2: of the lower triangle of each row's square,
  // then of its product with the residual.
  static constexpr std::size_t kTriangle = 21, kTerms = kTriangle + 7;  // one unused: whole vectors
  using Moments = std::array<std::array<double, kTerms>, 3>;

  // The lower triangle of a symmetric matrix whose knots have to do with the two before them at most: of knot
  // i the blocks (i, i), (i, i - 1) and (i, i - 2).
  using Band = std::vector<std::array<Matrix6d, 3>>;

  Band band() const;
  Eigen::VectorXd point_gradient() const;
  void add_difference(std::size_t first, std::span<const Matrix6d> moves, const Vector6d& residual,
                      const Vector6d& weights);

  double steps_per_u_;
  std::vector<Moments> moments_;  // of each step between two knots
  Band prior_;
  Eigen::VectorXd prior_gradient_;
};

}  // namespace sweepscope
