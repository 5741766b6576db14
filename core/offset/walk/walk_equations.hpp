#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/loam/path/guided_path.hpp"
#include "core/offset/walk/scan_equations.hpp"

namespace sweepscope {

/// Normal equations of a part of a walk: the path's blocks of six unknowns, and the offset last.
class WalkEquations {
 public:
  /// Of the matches of scans whose poses depend on the knots, and on a given motion's time shift, by
  /// `motions`. All three must outlive the equations.
  WalkEquations(const ScanEquations& matches, const std::vector<ScanMotion>& motions, const GuidedPath& path);
  /// The acceleration of the walk, or of its deviation from a given motion, changes little: third differences
  /// of the knots are near zero, to within sigma (rotation, translation).
  void add_jerks(const Eigen::Vector2d& sigma);
  /// Its velocity changes little: the same of the second differences.
  void add_accelerations(const Eigen::Vector2d& sigma);
  /// A map can be moved as a whole where there are knots, and a knot that sees little stays where it is.
  void hold(double first_sigma, double knot_sigma, double offset_sigma_s);
  /// The path begins, or ends, where it does.
  void hold_begin(double sigma) { hold_knots(0, sigma); }
  void hold_end(double sigma) { hold_knots(path_.knots() - kEndKnots, sigma); }

  /// Of half the sum of the squares, by the unknowns.
  const Eigen::VectorXd& gradient() const { return gradient_; }
  /// The normal matrix, and the same times steps without it. Of the matrix only the lower triangle.
  Eigen::MatrixXd matrix() const;
  Eigen::VectorXd product(const Eigen::VectorXd& steps) const;

  using Factor = Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>;
  struct Wanted {
    bool influence = false;
    std::optional<std::size_t> shift_block;   // whose influence is wanted as well
    const Eigen::MatrixXd* probes = nullptr;  // to be solved as well
  };
  struct Solution {
    std::vector<Vector6d> block_steps;
    double offset_step_s = 0;
    /// Of the gradient on the offset, and on a time shift. The last, or the shift's, is the variance.
    Eigen::VectorXd influence, shift_influence;
    Eigen::MatrixXd solved_probes;
  };
  /// By the factor of earlier, similar equations, without a matrix of their own, until a thousandth of the
  /// right side is left. With a factor of their own, which is kept in `factor`: where there is none yet,
  /// where the equations have become too different, of few unknowns, or with probes.
  std::optional<Solution> solve(const Wanted& wanted, std::optional<Factor>& factor) const;
  /// The steps alone, to a hundredth, of a path of any length: time and memory are proportional to it.
  std::optional<Solution> solve_long() const;

 private:
  // What sums of knots in a row are held near 0 by.
  struct Prior {
    std::span<const double> stencil;
    Vector6d weights;
  };
  using Precondition = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
  struct Accuracy {
    int max_steps;
    double tolerance;  // part of the right side that may be left
  };
  bool solve_near(const Precondition& precondition, const Accuracy& accuracy, const Eigen::VectorXd& right,
                  Eigen::VectorXd& x) const;
  Solution steps(const Eigen::VectorXd& solved) const;
  Eigen::SparseMatrix<double> band(const ScanEquations::Diagonal& matches) const;
  static constexpr std::size_t kEndKnots = 3;  // which either end of a path depends on
  void hold_knots(std::size_t first, double sigma);
  void add_prior(const Prior& prior, const std::vector<Vector6d>& residuals);
  template <typename Add>
  void add_priors(const Add& add) const;
  void add_matches(Eigen::MatrixXd& matrix) const;

  const ScanEquations& matches_;
  const std::vector<ScanMotion>& motions_;
  const GuidedPath& path_;
  Eigen::VectorXd gradient_;
  std::vector<Prior> priors_;
  Eigen::VectorXd held_;  // what is added to the diagonal
};

/// How something changes with all scans' poses, or with one's, and with the offset, from how it changes with
/// all unknowns, six each and the offset last.
ByScan by_scans(const Eigen::VectorXd& by_unknowns, const std::vector<ScanMotion>& motions,
                const GuidedPath& path);
Vector6d by_pose(const Eigen::VectorXd& by_unknowns, const ScanMotion& motion, const GuidedPath& path);

}  // namespace sweepscope
