#include "core/offset/walk/walk_equations.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <utility>

#include "core/offset/walk/jerk_prior.hpp"

namespace sweepscope {

using Eigen::Vector3d;

namespace {

// What the steps of a scan's pose have to do with blocks, by the unknowns that the pose depends on: every
// knot acts by its weight, the time shift as the first unknown of its block.
template <typename Knot, typename Shift>
void for_blocks(const GuidedPath::Place& place, const GuidedPath& path, const Knot& knot,
                const Shift& shift) {
  const auto& [first_knot, weights] = place.knots;
  for (std::size_t i = 0; i < 4 && path.knots() > 0; ++i) knot(first_knot + i, weights[i]);
  if (const auto block = path.shift_block()) shift(*block, place.per_shift_second);
}

// The sums of one scan with the others, by the blocks that those depend on. Blocks that none does are absent.
class WalkColumns {
 public:
  explicit WalkColumns(const GuidedPath& path) : path_(path), sums_(path.blocks()), used_(path.blocks()) {}

  void sum_up(std::uint32_t number, const ScanEquations::Scan& scan, const std::vector<ScanMotion>& motions) {
    std::fill(used_.begin(), used_.end(), false);
    for (const auto& [other, sum] : scan.products) {
      const Matrix6d half = (other == number ? 0.5 : 1.0) * sum;
      for_blocks(
          motions[other].place, path_,
          [&](std::size_t block, double weight) { at(block).noalias() += weight * half; },
          [&](std::size_t block, const Vector6d& per_second) {
            at(block).col(0).noalias() += half * per_second;
          });
    }
  }
  template <typename Use>
  void for_each(const Use& use) const {
    for (std::size_t block = 0; block < used_.size(); ++block)
      if (used_[block]) use(block, sums_[block]);
  }

 private:
  Matrix6d& at(std::size_t block) {
    if (!used_[block]) sums_[block].setZero();
    used_[block] = true;
    return sums_[block];
  }

  const GuidedPath& path_;
  std::vector<Matrix6d> sums_;
  std::vector<char> used_;
};

// Half of a matrix: it and its transpose are the whole.
void add_block(std::size_t row, std::size_t column, const Matrix6d& half, Eigen::MatrixXd& matrix) {
  const auto r = Eigen::Index(6 * row), c = Eigen::Index(6 * column);
  if (row >= column) matrix.block<6, 6>(r, c) += half;
  if (row <= column) matrix.block<6, 6>(c, r) += half.transpose();
}

Eigen::VectorXd by_unknowns(const ByScan& by_scan, const std::vector<ScanMotion>& motions,
                            const GuidedPath& path) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(Eigen::Index(6 * path.blocks() + 1));
  for (std::size_t i = 0; i < by_scan.scans.size(); ++i)
    for_blocks(
        motions[i].place, path,
        [&](std::size_t block, double weight) {
          sum.segment<6>(Eigen::Index(6 * block)) += weight * by_scan.scans[i];
        },
        [&](std::size_t block, const Vector6d& per_second) {
          sum[Eigen::Index(6 * block)] += per_second.dot(by_scan.scans[i]);
        });
  sum[sum.size() - 1] = by_scan.offset;
  return sum;
}

}  // namespace

WalkEquations::WalkEquations(const ScanEquations& matches, const std::vector<ScanMotion>& motions,
                             const GuidedPath& path)
    : matches_(matches),
      motions_(motions),
      path_(path),
      gradient_(by_unknowns(matches.gradient(), motions, path)),
      held_(Eigen::VectorXd::Zero(gradient_.size())) {}

namespace {

Vector6d weights_of(const Eigen::Vector2d& sigma) {
  Vector6d weights;
  weights << Vector3d::Constant(1 / (sigma[0] * sigma[0])), Vector3d::Constant(1 / (sigma[1] * sigma[1]));
  return weights;
}

}  // namespace

void WalkEquations::add_jerks(const Eigen::Vector2d& sigma) {
  add_prior({kJerkStencil, weights_of(sigma)}, third_differences(path_));
}

void WalkEquations::add_accelerations(const Eigen::Vector2d& sigma) {
  add_prior({kAccelerationStencil, weights_of(sigma)}, second_differences(path_));
}

void WalkEquations::add_prior(const Prior& prior, const std::vector<Vector6d>& residuals) {
  priors_.push_back(prior);
  for (std::size_t k = 0; k < residuals.size(); ++k)
    for (std::size_t a = 0; a < prior.stencil.size(); ++a)
      gradient_.segment<6>(Eigen::Index(6 * (k + a))) +=
          prior.stencil[a] * prior.weights.cwiseProduct(residuals[k]);
}

// add(row, column, diagonal) for each two knots, row >= column, that a prior joins.
template <typename Add>
void WalkEquations::add_priors(const Add& add) const {
  for (const auto& [stencil, weights] : priors_)
    for (std::size_t k = 0; k + stencil.size() <= path_.knots(); ++k)
      for (std::size_t a = 0; a < stencil.size(); ++a)
        for (std::size_t b = 0; b <= a; ++b) add(k + a, k + b, Vector6d(stencil[a] * stencil[b] * weights));
}

void WalkEquations::hold(double first_sigma, double knot_sigma, double offset_sigma_s) {
  const Eigen::Index last = held_.size() - 1;
  held_.head(last).array() += 1 / (knot_sigma * knot_sigma);
  if (path_.knots() > 0) held_.head<6>().array() += 1 / (first_sigma * first_sigma);
  held_[last] += 1 / (offset_sigma_s * offset_sigma_s);
}

void WalkEquations::hold_knots(std::size_t first, double sigma) {
  if (path_.knots() < kEndKnots) return;
  held_.segment<6 * kEndKnots>(Eigen::Index(6 * first)).array() += 1 / (sigma * sigma);
}

Eigen::MatrixXd WalkEquations::matrix() const {
  Eigen::MatrixXd matrix = held_.asDiagonal();
  add_matches(matrix);
  add_priors([&](std::size_t row, std::size_t column, const Vector6d& diagonal) {
    matrix.block<6, 6>(Eigen::Index(6 * row), Eigen::Index(6 * column)).diagonal() += diagonal;
  });
  return matrix;
}

void WalkEquations::add_matches(Eigen::MatrixXd& matrix) const {
  const Eigen::Index last = matrix.rows() - 1;
  const ScanEquations::Matrix by_scan = matches_.matrix();
  WalkColumns columns(path_);
  for (std::uint32_t number = 0; number < by_scan.scans.size(); ++number) {
    const ScanEquations::Scan& scan = by_scan.scans[number];
    if (scan.products.empty()) continue;
    columns.sum_up(number, scan, motions_);
    for_blocks(
        motions_[number].place, path_,
        [&](std::size_t row, double weight) {
          columns.for_each(
              [&](std::size_t column, const Matrix6d& sum) { add_block(row, column, weight * sum, matrix); });
          matrix.block<1, 6>(last, Eigen::Index(6 * row)) += weight * scan.with_offset.transpose();
        },
        [&](std::size_t row, const Vector6d& per_second) {
          columns.for_each([&](std::size_t column, const Matrix6d& sum) {
            Matrix6d first_only = Matrix6d::Zero();
            first_only.row(0) = per_second.transpose() * sum;
            add_block(row, column, first_only, matrix);
          });
          matrix(last, Eigen::Index(6 * row)) += per_second.dot(scan.with_offset);
        });
  }
  matrix(last, last) += by_scan.offset_square;
}

Eigen::VectorXd WalkEquations::product(const Eigen::VectorXd& steps) const {
  Eigen::VectorXd sum = held_.cwiseProduct(steps);
  sum += by_unknowns(matches_.product(by_scans(steps, motions_, path_)), motions_, path_);
  const auto knot = [](std::size_t i) { return Eigen::Index(6 * i); };
  for (const auto& [stencil, weights] : priors_)
    for (std::size_t k = 0; k + stencil.size() <= path_.knots(); ++k) {
      Vector6d difference = Vector6d::Zero();
      for (std::size_t a = 0; a < stencil.size(); ++a)
        difference += stencil[a] * steps.segment<6>(knot(k + a));
      const Vector6d weighted = weights.cwiseProduct(difference);
      for (std::size_t a = 0; a < stencil.size(); ++a) sum.segment<6>(knot(k + a)) += stencil[a] * weighted;
    }
  return sum;
}

// By conjugate gradients. False where so many steps are not enough.
bool WalkEquations::solve_near(const Precondition& precondition, const Accuracy& accuracy,
                               const Eigen::VectorXd& right, Eigen::VectorXd& x) const {
  x.setZero(right.size());
  Eigen::VectorXd left = right, direction = Eigen::VectorXd::Zero(right.size());
  double square = 1;
  for (int i = 0; i < accuracy.max_steps; ++i) {
    const Eigen::VectorXd preconditioned = precondition(left);
    const double before = std::exchange(square, left.dot(preconditioned));
    direction = preconditioned + (i > 0 ? square / before : 0) * direction;
    const Eigen::VectorXd changed = product(direction);
    const double length = square / direction.dot(changed);
    x += length * direction;
    left -= length * changed;
    if (left.norm() <= accuracy.tolerance * right.norm()) return true;
  }
  return false;
}

WalkEquations::Solution WalkEquations::steps(const Eigen::VectorXd& solved) const {
  const Eigen::Index last = solved.size() - 1;
  Solution solution;
  solution.offset_step_s = solved[last];
  for (Eigen::Index k = 0; k < last / 6; ++k) solution.block_steps.push_back(solved.segment<6>(6 * k));
  return solution;
}

// With the factor as the preconditioner, on a walk of 60 s 4 to 11 steps were enough, which take less time
// than a matrix.
std::optional<WalkEquations::Solution> WalkEquations::solve(const Wanted& wanted,
                                                            std::optional<Factor>& factor) const {
  const Eigen::Index last = gradient_.size() - 1;
  const auto unit = [&](Eigen::Index i) { return Eigen::VectorXd::Unit(gradient_.size(), i); };
  std::vector<Eigen::VectorXd> rights = {-gradient_};
  if (wanted.influence) rights.push_back(unit(last));
  if (wanted.influence && wanted.shift_block) rights.push_back(unit(Eigen::Index(6 * *wanted.shift_block)));
  std::vector<Eigen::VectorXd> solved(rights.size());
  constexpr Eigen::Index kFew = 100;  // unknowns, of which a factor takes no time
  // The next iteration, which matches again, moves by far more than this leaves.
  constexpr Accuracy kAccuracy{20, 1e-3};
  const auto precondition = [&](const Eigen::VectorXd& left) -> Eigen::VectorXd {
    return factor->solve(left);
  };
  bool near = factor && last > kFew && wanted.probes == nullptr;
  for (std::size_t i = 0; near && i < rights.size(); ++i)
    near = solve_near(precondition, kAccuracy, rights[i], solved[i]);
  if (!near) {
    factor.emplace(matrix());
    if (factor->info() != Eigen::Success) return std::nullopt;
    for (std::size_t i = 0; i < rights.size(); ++i) solved[i] = factor->solve(rights[i]);
  }
  Solution solution = steps(solved[0]);
  if (solved.size() > 1) solution.influence = std::move(solved[1]);
  if (solved.size() > 2) solution.shift_influence = std::move(solved[2]);
  if (wanted.probes != nullptr) solution.solved_probes = factor->solve(*wanted.probes);
  return solution;
}

// The normal matrix without the offset and without what matches say of two scans: what is left of it joins
// knots that an instant, or a jerk, depends on.
Eigen::SparseMatrix<double> WalkEquations::band(const ScanEquations::Diagonal& matches) const {
  constexpr std::size_t kWidth = kJerkStencil.size();  // as many as an instant depends on
  std::vector<std::array<Matrix6d, kWidth>> blocks(
      path_.blocks());  // of each: with itself, with the one before it, ...
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    blocks[k].fill(Matrix6d::Zero());
    blocks[k][0] = held_.segment<6>(Eigen::Index(6 * k)).asDiagonal();
  }
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const auto& [first, weights] = motions_[i].place.knots;
    for (std::size_t a = 0; a < kWidth && path_.knots() > 0; ++a)
      for (std::size_t b = 0; b <= a; ++b)
        blocks[first + a][a - b] += weights[a] * weights[b] * matches.scans[i];
    if (const auto block = path_.shift_block()) {
      const Vector6d& per_second = motions_[i].place.per_shift_second;
      blocks[*block][0](0, 0) += per_second.dot(matches.scans[i] * per_second);
    }
  }
  add_priors([&](std::size_t row, std::size_t column, const Vector6d& diagonal) {
    blocks[row][row - column].diagonal() += diagonal;
  });
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t row = 0; row < blocks.size(); ++row)
    for (std::size_t lag = 0; lag < std::min(kWidth, row + 1); ++lag)
      for (int r = 0; r < 6; ++r)
        for (int c = 0; c < (lag == 0 ? r + 1 : 6); ++c)
          entries.emplace_back(int(6 * row) + r, int(6 * (row - lag)) + c, blocks[row][lag](r, c));
  Eigen::SparseMatrix<double> band(gradient_.size() - 1, gradient_.size() - 1);
  band.setFromTriplets(entries.begin(), entries.end());
  return band;
}

std::optional<WalkEquations::Solution> WalkEquations::solve_long() const {
  const ScanEquations::Diagonal diagonal = matches_.diagonal();
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(
      band(diagonal));
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::Index last = gradient_.size() - 1;
  const double offset_square = held_[last] + diagonal.offset_square;
  const auto precondition = [&](const Eigen::VectorXd& left) {
    Eigen::VectorXd steps(left.size());
    steps.head(last) = factor.solve(left.head(last));
    steps[last] = left[last] / offset_square;
    return steps;
  };
  constexpr Accuracy kAccuracy{200, 1e-2};
  Eigen::VectorXd solved;
  solve_near(precondition, kAccuracy, -gradient_, solved);  // or as near as it came
  return steps(solved);
}

ByScan by_scans(const Eigen::VectorXd& by_unknowns, const std::vector<ScanMotion>& motions,
                const GuidedPath& path) {
  ByScan by_scan;
  by_scan.scans.reserve(motions.size());
  for (const ScanMotion& motion : motions) by_scan.scans.push_back(by_pose(by_unknowns, motion, path));
  by_scan.offset = by_unknowns[by_unknowns.size() - 1];
  return by_scan;
}

Vector6d by_pose(const Eigen::VectorXd& by_unknowns, const ScanMotion& motion, const GuidedPath& path) {
  Vector6d sum = Vector6d::Zero();
  for_blocks(
      motion.place, path,
      [&](std::size_t block, double weight) {
        sum += weight * by_unknowns.segment<6>(Eigen::Index(6 * block));
      },
      [&](std::size_t block, const Vector6d& per_second) {
        sum += by_unknowns[Eigen::Index(6 * block)] * per_second;
      });
  return sum;
}

}  // namespace sweepscope
