#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/loam/feature_map.hpp"
#include "core/loam/guided_path.hpp"

namespace sweepscope {

/// What the points of a scan, or of a slice of one, share: where the motor's axis was, how fast it turned,
/// and between which knots.
struct ScanMotion {
  GuidedPath::Place place;
  Eigen::Vector3d base_in_map_m, turning_rad_s;
};

/// How a distance changes with the steps of the knots that it depends on: its own point's four, and those of
/// the neighbours that its surface was fitted to; and with that of a given motion's time shift.
class KnotRow {
 public:
  void clear() { count_ = 0; }

  void add(std::size_t knot, const Vector6d& row) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (knots_[i] != knot) continue;
      rows_[i] += row;
      return;
    }
    knots_[count_] = knot;
    rows_[count_] = row;
    ++count_;
  }
  /// The row of one point at `p_m` that was measured during `scan`, times `share`, along `normal`. Gives how
  /// the point's distance changes with the offset, times `share`.
  double add_point(const GuidedPath& path, const ScanMotion& scan, const Eigen::Vector3d& p_m,
                   const Eigen::Vector3d& normal, double share);
  std::size_t size() const { return count_; }
  /// How the distance changes with steps of all unknowns, six each.
  double times(const Eigen::VectorXd& knot_steps) const {
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i)
      sum += rows_[i].dot(knot_steps.segment<6>(Eigen::Index(6 * knots_[i])));
    return sum;
  }
  std::size_t knot(std::size_t i) const { return knots_[i]; }
  const Vector6d& row(std::size_t i) const { return rows_[i]; }

 private:
  static constexpr std::size_t kMax = 5 + 4 * Neighbours::kMax;  // the offset, and four knots per point
  std::size_t count_ = 0;
  std::array<std::size_t, kMax> knots_;
  std::array<Vector6d, kMax> rows_;
};

/// Normal equations of a part of a walk: the path's blocks of six unknowns, and the offset last. Only the
/// lower triangle.
class WalkEquations {
 public:
  explicit WalkEquations(std::size_t blocks);

  void add(const KnotRow& row, double offset_slope, double residual, double weight);
  /// The acceleration of the walk, or of its deviation from a given motion, changes little: third differences
  /// of the knots are near zero, to within sigma (rotation, translation).
  void add_jerks(const GuidedPath& path, const Eigen::Vector2d& sigma);
  /// A map can be moved as a whole where there are knots, and a knot that sees little stays where it is.
  void hold(std::size_t knots, double first_sigma, double knot_sigma, double offset_sigma_s);

  /// Of half the sum of the squares, by the unknowns.
  const Eigen::VectorXd& gradient() const { return gradient_; }

  struct Solution {
    std::vector<Vector6d> block_steps;
    double offset_step_s, offset_sigma_s;
    Eigen::VectorXd influence, shift_influence;  // of the gradient on the offset, and on a time shift
    Eigen::MatrixXd solved_probes;
  };
  /// Once: the matrix becomes its factor.
  std::optional<Solution> solve(std::optional<std::size_t> shift_block, const Eigen::MatrixXd& probes);

 private:
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gradient_;
};

}  // namespace sweepscope
