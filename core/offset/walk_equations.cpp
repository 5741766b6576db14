#include "core/offset/walk_equations.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

#include "core/offset/jerk_prior.hpp"

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
class Columns {
 public:
  explicit Columns(const GuidedPath& path) : path_(path), sums_(path.blocks()), used_(path.blocks()) {}

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

// What Eigen's conjugate gradients ask of a preconditioner.
class ByEarlierFactor {
 public:
  ByEarlierFactor() = default;
  void use(const WalkEquations::Factor& factor) { factor_ = &factor; }

  template <typename Matrix>
  ByEarlierFactor& compute(const Matrix&) {
    return *this;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const { return factor_->solve(right); }
  Eigen::ComputationInfo info() const { return Eigen::Success; }

 private:
  const WalkEquations::Factor* factor_ = nullptr;
};

}  // namespace

WalkEquations::WalkEquations(std::size_t blocks)
    : matrix_(Eigen::MatrixXd::Zero(Eigen::Index(6 * blocks + 1), Eigen::Index(6 * blocks + 1))),
      gradient_(Eigen::VectorXd::Zero(matrix_.rows())) {}

// Half of the matrix: it and its transpose are the whole.
void WalkEquations::add_block(std::size_t row, std::size_t column, const Matrix6d& half) {
  const auto r = Eigen::Index(6 * row), c = Eigen::Index(6 * column);
  if (row >= column) matrix_.block<6, 6>(r, c) += half;
  if (row <= column) matrix_.block<6, 6>(c, r) += half.transpose();
}

void WalkEquations::add(const ScanEquations& scans, const std::vector<ScanMotion>& motions,
                        const GuidedPath& path) {
  const Eigen::Index last = matrix_.rows() - 1;
  Columns columns(path);
  for (std::uint32_t number = 0; number < scans.scans().size(); ++number) {
    const ScanEquations::Scan& scan = scans.scans()[number];
    if (scan.products.empty()) continue;
    columns.sum_up(number, scan, motions);
    for_blocks(
        motions[number].place, path,
        [&](std::size_t row, double weight) {
          columns.for_each(
              [&](std::size_t column, const Matrix6d& sum) { add_block(row, column, weight * sum); });
          gradient_.segment<6>(Eigen::Index(6 * row)) += weight * scan.gradient;
          matrix_.block<1, 6>(last, Eigen::Index(6 * row)) += weight * scan.with_offset.transpose();
        },
        [&](std::size_t row, const Vector6d& per_second) {
          columns.for_each([&](std::size_t column, const Matrix6d& sum) {
            Matrix6d first_only = Matrix6d::Zero();
            first_only.row(0) = per_second.transpose() * sum;
            add_block(row, column, first_only);
          });
          gradient_[Eigen::Index(6 * row)] += per_second.dot(scan.gradient);
          matrix_(last, Eigen::Index(6 * row)) += per_second.dot(scan.with_offset);
        });
  }
  gradient_[last] += scans.offset_gradient();
  matrix_(last, last) += scans.offset_square();
}

void WalkEquations::add_jerks(const GuidedPath& path, const Eigen::Vector2d& sigma) {
  const std::vector<Vector6d> residuals = third_differences(path);
  Vector6d weights;
  weights << Vector3d::Constant(1 / (sigma[0] * sigma[0])), Vector3d::Constant(1 / (sigma[1] * sigma[1]));
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    for (std::size_t a = 0; a < kJerkStencil.size(); ++a) {
      const auto row = Eigen::Index(6 * (k + a));
      gradient_.segment<6>(row) += kJerkStencil[a] * weights.cwiseProduct(residuals[k]);
      for (std::size_t b = 0; b <= a; ++b)
        matrix_.block<6, 6>(row, Eigen::Index(6 * (k + b))).diagonal() +=
            kJerkStencil[a] * kJerkStencil[b] * weights;
    }
  }
}

void WalkEquations::hold(std::size_t knots, double first_sigma, double knot_sigma, double offset_sigma_s) {
  const Eigen::Index last = matrix_.rows() - 1;
  matrix_.diagonal().head(last).array() += 1 / (knot_sigma * knot_sigma);
  if (knots > 0) matrix_.diagonal().head<6>().array() += 1 / (first_sigma * first_sigma);
  matrix_(last, last) += 1 / (offset_sigma_s * offset_sigma_s);
}

// By conjugate gradients, each step of which is a product with the matrix and a solution with the factor: on
// a walk of 60 s 4 to 11 were enough, which take less time than a factor. False where they are not.
bool WalkEquations::solve_near(const Factor& earlier, const Eigen::VectorXd& right,
                               Eigen::VectorXd& x) const {
  constexpr int kMaxSteps = 12;
  constexpr double kTolerance = 1e-3;  // the next iteration, which matches anew, moves by far more
  Eigen::ConjugateGradient<Eigen::MatrixXd, Eigen::Lower, ByEarlierFactor> gradients;
  gradients.setMaxIterations(kMaxSteps).setTolerance(kTolerance);
  gradients.preconditioner().use(earlier);
  gradients.compute(matrix_);
  x = gradients.solve(right);
  return gradients.info() == Eigen::Success;
}

std::optional<WalkEquations::Solution> WalkEquations::solve(const Wanted& wanted,
                                                            std::optional<Factor>& factor) const {
  const Eigen::Index last = matrix_.rows() - 1;
  const auto unit = [&](Eigen::Index i) { return Eigen::VectorXd::Unit(matrix_.rows(), i); };
  std::vector<Eigen::VectorXd> rights = {-gradient_};
  if (wanted.influence) rights.push_back(unit(last));
  if (wanted.influence && wanted.shift_block) rights.push_back(unit(Eigen::Index(6 * *wanted.shift_block)));
  std::vector<Eigen::VectorXd> solved(rights.size());
  constexpr Eigen::Index kFew = 100;  // unknowns, of which a factor takes no time
  bool near = factor && last > kFew && wanted.probes == nullptr;
  for (std::size_t i = 0; near && i < rights.size(); ++i) near = solve_near(*factor, rights[i], solved[i]);
  if (!near) {
    factor.emplace(matrix_);
    if (factor->info() != Eigen::Success) return std::nullopt;
    for (std::size_t i = 0; i < rights.size(); ++i) solved[i] = factor->solve(rights[i]);
  }
  Solution solution;
  solution.offset_step_s = solved[0][last];
  for (Eigen::Index k = 0; k < last / 6; ++k) solution.block_steps.push_back(solved[0].segment<6>(6 * k));
  if (solved.size() > 1) solution.influence = std::move(solved[1]);
  if (solved.size() > 2) solution.shift_influence = std::move(solved[2]);
  if (wanted.probes != nullptr) solution.solved_probes = factor->solve(*wanted.probes);
  return solution;
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
