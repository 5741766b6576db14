#include "core/loam/path/path_equations.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace sweepscope {
namespace {

// How a pose's step about the pivot moves the pose itself.
Matrix6d own_step(const Pose& pose, const Eigen::Vector3d& pivot_m) {
  const Eigen::Vector3d d = pose.translation_m - pivot_m;
  Matrix6d m = Matrix6d::Identity();
  m.block<3, 3>(3, 0) << 0, d.z(), -d.y(), -d.z(), 0, d.x(), d.y(), -d.x(), 0;  // step x d = -[d]x step
  return m;
}

// Where a given motion leads to knot i from the one before it; without one a pose stays.
Pose moved(const Pose& from, std::span<const Pose> moves, std::size_t i) {
  return moves.empty() ? from : from * moves[i];
}

Vector6d weights_of(const Eigen::Vector2d& sigma) {
  Vector6d weights;
  weights << Eigen::Vector3d::Constant(1 / (sigma[0] * sigma[0])),
      Eigen::Vector3d::Constant(1 / (sigma[1] * sigma[1]));
  return weights;
}

}  // namespace

Vector6d difference(const Pose& to, const Pose& from) {
  Vector6d d;
  d << vector_from_rotation(to.rotation * from.rotation.conjugate()), to.translation_m - from.translation_m;
  return d;
}

PathEquations::PathEquations(std::size_t knots, double end_u)
    : steps_per_u_(double(knots - 1) / end_u),
      moments_(knots - 1, Moments{}),
      prior_(knots, {Matrix6d::Zero(), Matrix6d::Zero(), Matrix6d::Zero()}),
      prior_gradient_(Eigen::VectorXd::Zero(Eigen::Index(6 * knots))) {}

void PathEquations::add(double u, const Vector6d& row, double residual, double weight) {
  std::array<double, kTerms> terms{};
  std::size_t term = 0;
  for (int i = 0; i < 6; ++i) {
    const double weighted = weight * row[i];
    for (int j = 0; j <= i; ++j) terms[term++] = weighted * row[j];
    terms[kTriangle + std::size_t(i)] = weighted * residual;
  }
  const double place = u * steps_per_u_;
  const auto step = std::size_t(std::clamp(place, 0.0, double(moments_.size() - 1)));
  const double f = place - double(step), f2 = f * f;
  Moments& to = moments_[step];
  for (std::size_t k = 0; k < kTerms; ++k) {
    to[0][k] += terms[k];
    to[1][k] += f * terms[k];
    to[2][k] += f2 * terms[k];
  }
}

PathEquations::Band PathEquations::band() const {
  Band band = prior_;
  for (std::size_t s = 0; s < moments_.size(); ++s) {
    const Moments& m = moments_[s];
    std::size_t term = 0;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j, ++term) {
        const double first = m[0][term] - 2 * m[1][term] + m[2][term], both = m[1][term] - m[2][term];
        const auto put = [&](int r, int c) {
          band[s][0](r, c) += first;
          band[s + 1][0](r, c) += m[2][term];
          band[s + 1][1](r, c) += both;
        };
        put(i, j);
        if (i != j) put(j, i);
      }
  }
  return band;
}

Eigen::MatrixXd PathEquations::matrix() const {
  const Band lower = band();
  const auto n = Eigen::Index(6 * lower.size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < lower.size(); ++i)
    for (std::size_t back = 0; back <= std::min<std::size_t>(i, 2); ++back) {
      const auto row = Eigen::Index(6 * i), column = Eigen::Index(6 * (i - back));
      whole.block<6, 6>(row, column) = lower[i][back];
      whole.block<6, 6>(column, row) = lower[i][back].transpose();
    }
  return whole;
}

Eigen::VectorXd PathEquations::point_gradient() const {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(prior_gradient_.rows());
  for (std::size_t s = 0; s < moments_.size(); ++s)
    for (std::size_t i = 0; i < 6; ++i) {
      const Moments& m = moments_[s];
      g[Eigen::Index(6 * s + i)] += m[0][kTriangle + i] - m[1][kTriangle + i];
      g[Eigen::Index(6 * s + i + 6)] += m[1][kTriangle + i];
    }
  return g;
}

// Of knots from `first` on, each of which moves the residual by its matrix.
void PathEquations::add_difference(std::size_t first, std::span<const Matrix6d> moves,
                                   const Vector6d& residual, const Vector6d& weights) {
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const auto row = Eigen::Index(6 * (first + k));
    const Matrix6d weighted = moves[k].transpose() * weights.asDiagonal();
    prior_gradient_.segment<6>(row) += weighted * residual;
    for (std::size_t l = 0; l <= k; ++l) prior_[first + k][k - l] += weighted * moves[l];
  }
}

void PathEquations::add_accelerations(std::span<const Pose> knots, const Pose& before,
                                      const Eigen::Vector2d& sigma, const Eigen::Vector3d& pivot_m,
                                      std::span<const Pose> moves) {
  const Vector6d weights = weights_of(sigma);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Pose last = moved(i == 0 ? before : knots[i - 1], moves, i), here = moved(knots[i], moves, i + 1);
    const Vector6d residual = difference(knots[i + 1], here) - difference(knots[i], last);
    const std::array<Matrix6d, 3> steps{own_step(last, pivot_m),
                                        -(own_step(knots[i], pivot_m) + own_step(here, pivot_m)),
                                        own_step(knots[i + 1], pivot_m)};
    if (i == 0)
      add_difference(0, std::span(steps).last(2), residual, weights);
    else
      add_difference(i - 1, steps, residual, weights);
  }
}

void PathEquations::add_velocities(std::span<const Pose> knots, double sigma, const Eigen::Vector3d& pivot_m,
                                   std::span<const Pose> moves) {
  const Vector6d weights = weights_of({sigma, sigma});
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Pose here = moved(knots[i], moves, i + 1);
    const std::array<Matrix6d, 2> steps{-own_step(here, pivot_m), own_step(knots[i + 1], pivot_m)};
    add_difference(i, steps, difference(knots[i + 1], here), weights);
  }
}

void PathEquations::add_tie(const Pose& first_knot, const Pose& given, double sigma,
                            const Eigen::Vector3d& pivot_m) {
  const std::array<Matrix6d, 1> moves{own_step(first_knot, pivot_m)};
  add_difference(0, moves, difference(first_knot, given), weights_of({sigma, sigma}));
}

// By block factors L D L', L with unit diagonal: L y = gradient, then D L' x = -y. `ldlt` allows for
// directions that nothing determines.
std::vector<Vector6d> PathEquations::solve() const {
  const Band a = band();
  const Eigen::VectorXd g = gradient();
  const std::size_t knots = a.size();
  std::vector<Eigen::LDLT<Matrix6d>> d(knots);
  std::vector<std::array<Matrix6d, 3>> l(knots);  // of knot i what it has to do with i - 1 and i - 2
  std::vector<Vector6d> steps(knots);
  for (std::size_t i = 0; i < knots; ++i) {
    Matrix6d of_last = a[i][1], here = a[i][0];
    steps[i] = g.segment<6>(Eigen::Index(6 * i));
    if (i >= 2) {
      l[i][2] = d[i - 2].solve(a[i][2].transpose()).transpose();
      of_last.noalias() -= a[i][2] * l[i - 1][1].transpose();
      here.noalias() -= a[i][2] * l[i][2].transpose();
      steps[i].noalias() -= l[i][2] * steps[i - 2];
    }
    if (i >= 1) {
      l[i][1] = d[i - 1].solve(of_last.transpose()).transpose();
      here.noalias() -= of_last * l[i][1].transpose();
      steps[i].noalias() -= l[i][1] * steps[i - 1];
    }
    d[i].compute(here);
  }
  for (std::size_t i = knots; i-- > 0;) {
    steps[i] = -d[i].solve(steps[i]);
    if (i + 1 < knots) steps[i].noalias() -= l[i + 1][1].transpose() * steps[i + 1];
    if (i + 2 < knots) steps[i].noalias() -= l[i + 2][2].transpose() * steps[i + 2];
  }
  return steps;
}

}  // namespace sweepscope
