#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <array>

#include "core/geometry/pose.hpp"

namespace sweepscope {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix18d = Eigen::Matrix<double, 18, 18>;
using Vector18d = Eigen::Matrix<double, 18, 1>;

/// A step of a pose: rotation vector (rad) about `pivot_m`, then translation (m), both in the map frame.
inline Pose stepped(const Pose& pose, const Vector6d& step, const Eigen::Vector3d& pivot_m) {
  const Eigen::Quaterniond turn = rotation_from_vector(step.head<3>());
  return {(turn * pose.rotation).normalized(),
          turn * (pose.translation_m - pivot_m) + pivot_m + step.tail<3>()};
}

/// The row of the Jacobian of a distance along `normal` at `p_m` for a step about `pivot_m`.
inline Vector6d distance_jacobian(const Eigen::Vector3d& p_m, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& pivot_m) {
  Vector6d row;
  row << (p_m - pivot_m).cross(normal), normal;
  return row;
}

/// Weight of a residual that a Cauchy loss of width `scale` gives.
inline double cauchy_weight(double residual, double scale) {
  const double ratio = residual / scale;
  return 1.0 / (1.0 + ratio * ratio);
}

/// How much of a sweep's bend acts at u: all of it in the middle, nothing at the ends.
inline double bend_at(double u) {
  return 4 * u * (1 - u);
}

/// Normal equations of a sweep's motion, a pose at its begin, one at its end and the bend between them (see
/// SweepMotion), from points measured at u: a point's row J acts as (1 - u) J on the begin's step, u J on the
/// end's and 4 u (1 - u) J on the bend's.
class SweepEquations {
 public:
  void add(const Vector6d& row, double residual, double weight, double u) {
    std::array<double, kTerms> terms{};  // the lower triangle of the row's square, then its gradient
    std::size_t term = 0;
    for (int i = 0; i < 6; ++i) {
      const double weighted = weight * row[i];
      for (int j = 0; j <= i; ++j) terms[term++] = weighted * row[j];
      terms[kTriangle + std::size_t(i)] = weighted * residual;
    }
    const Polynomial powers{1, u, u * u, u * u * u, (u * u) * (u * u)};
    for (std::size_t power = 0; power < moments_.size(); ++power)
      for (std::size_t k = 0; k < kTerms; ++k) moments_[power][k] += powers[power] * terms[k];
  }

  Matrix18d matrix() const {
    Matrix18d a;
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) a.block<6, 6>(6 * p, 6 * q) = block(product(kShares[p], kShares[q]));
    return a;
  }
  Vector18d gradient() const {
    Vector18d g = Vector18d::Zero();
    for (int p = 0; p < 3; ++p)
      for (std::size_t power = 0; power < 3; ++power)
        for (int i = 0; i < 6; ++i)
          g[6 * p + i] += kShares[p][power] * moments_[power][kTriangle + std::size_t(i)];
    return g;
  }

 private:
  // All shares are polynomials of u, so it does to sum each point's terms times the powers of u.
  using Polynomial = std::array<double, 5>;
  static constexpr std::array<Polynomial, 3> kShares{{{1, -1}, {0, 1}, {0, 4, -4}}};  // begin, end, bend
  static constexpr std::size_t kTriangle = 21, kTerms = kTriangle + 7;  // one unused: whole vectors

  static constexpr Polynomial product(const Polynomial& a, const Polynomial& b) {
    Polynomial c{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) c[i + j] += a[i] * b[j];
    return c;
  }
  Matrix6d block(const Polynomial& share) const {
    Matrix6d m;
    std::size_t term = 0;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j, ++term) {
        double sum = 0;
        for (std::size_t power = 0; power < moments_.size(); ++power)
          sum += share[power] * moments_[power][term];
        m(i, j) = m(j, i) = sum;
      }
    return m;
  }

  std::array<std::array<double, kTerms>, 5> moments_{};
};

/// Minimises x' A x / 2 + g' x, leaving the directions alone whose eigenvalue is below `least_eigenvalue`:
/// what the scene does not determine keeps its value. `free_directions` counts them.
inline Vector6d solve_determined(const Matrix6d& a, const Vector6d& g, double least_eigenvalue,
                                 int& free_directions) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(a);
  Vector6d step = Vector6d::Zero();
  free_directions = 0;
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] < least_eigenvalue) {
      ++free_directions;
      continue;
    }
    step -= solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(g) / solver.eigenvalues()[i]);
  }
  return step;
}

}  // namespace sweepscope
