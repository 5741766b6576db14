#include "core/offset/walk_equations.hpp"

#include <Eigen/Cholesky>

#include "core/loam/least_squares.hpp"
#include "core/offset/jerk_prior.hpp"

namespace sweepscope {

using Eigen::Vector3d;

double KnotRow::add_point(const GuidedPath& path, const ScanMotion& scan, const Vector3d& p_m,
                          const Vector3d& normal, double share) {
  const Vector6d row = share * distance_jacobian(p_m, normal, scan.base_in_map_m);
  const auto& [first_knot, weights] = scan.place.knots;
  for (std::size_t i = 0; i < 4 && path.knots() > 0; ++i) add(first_knot + i, weights[i] * row);
  if (const auto block = path.shift_block())
    add(*block, row.dot(scan.place.per_shift_second) * Vector6d::Unit(0));
  return share * normal.dot(scan.turning_rad_s.cross(p_m - scan.base_in_map_m));
}

WalkEquations::WalkEquations(std::size_t blocks)
    : matrix_(Eigen::MatrixXd::Zero(Eigen::Index(6 * blocks + 1), Eigen::Index(6 * blocks + 1))),
      gradient_(Eigen::VectorXd::Zero(matrix_.rows())) {}

void WalkEquations::add(const KnotRow& row, double offset_slope, double residual, double weight) {
  const Eigen::Index last = matrix_.rows() - 1;
  for (std::size_t a = 0; a < row.size(); ++a) {
    const Vector6d weighted = weight * row.row(a);
    const auto ka = Eigen::Index(6 * row.knot(a));
    for (std::size_t b = 0; b < row.size(); ++b)
      if (row.knot(b) <= row.knot(a))
        matrix_.block<6, 6>(ka, Eigen::Index(6 * row.knot(b))).noalias() += weighted * row.row(b).transpose();
    matrix_.block<1, 6>(last, ka) += offset_slope * weighted.transpose();
    gradient_.segment<6>(ka) += residual * weighted;
  }
  matrix_(last, last) += weight * offset_slope * offset_slope;
  gradient_[last] += weight * offset_slope * residual;
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

std::optional<WalkEquations::Solution> WalkEquations::solve(std::optional<std::size_t> shift_block,
                                                            const Eigen::MatrixXd& probes) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> cholesky(matrix_);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const Eigen::Index last = matrix_.rows() - 1;
  const Eigen::VectorXd x = cholesky.solve(-gradient_);
  Solution solution{{}, x[last], 1 / matrix_(last, last),
                    {}, {},      cholesky.solve(probes)};  // now the factor's
  solution.influence = cholesky.solve(Eigen::VectorXd::Unit(matrix_.rows(), last));
  if (shift_block)
    solution.shift_influence =
        cholesky.solve(Eigen::VectorXd::Unit(matrix_.rows(), Eigen::Index(6 * *shift_block)));
  for (Eigen::Index k = 0; k < last / 6; ++k) solution.block_steps.push_back(x.segment<6>(6 * k));
  return solution;
}

}  // namespace sweepscope
