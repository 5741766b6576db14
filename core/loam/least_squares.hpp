#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

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
    const Matrix6d outer = (weight * row) * row.transpose();
    const Vector6d gradient = (weight * residual) * row;
    const double v = 1.0 - u, b = bend_at(u);
    begin_begin_ += v * v * outer;
    begin_end_ += u * v * outer;
    end_end_ += u * u * outer;
    begin_bend_ += v * b * outer;
    end_bend_ += u * b * outer;
    bend_bend_ += b * b * outer;
    begin_ += v * gradient;
    end_ += u * gradient;
    bend_ += b * gradient;
  }

  Matrix18d matrix() const {
    Matrix18d a;
    a << begin_begin_, begin_end_, begin_bend_, begin_end_, end_end_, end_bend_, begin_bend_, end_bend_,
        bend_bend_;
    return a;
  }
  Vector18d gradient() const {
    Vector18d g;
    g << begin_, end_, bend_;
    return g;
  }

 private:
  Matrix6d begin_begin_ = Matrix6d::Zero(), begin_end_ = Matrix6d::Zero(), end_end_ = Matrix6d::Zero();
  Matrix6d begin_bend_ = Matrix6d::Zero(), end_bend_ = Matrix6d::Zero(), bend_bend_ = Matrix6d::Zero();
  Vector6d begin_ = Vector6d::Zero(), end_ = Vector6d::Zero(), bend_ = Vector6d::Zero();
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
