#include "core/loam/path/least_squares.hpp"

#include <Eigen/Eigenvalues>

namespace sweepscope {

Vector6d solve_determined(const Matrix6d& a, const Vector6d& g, double min_eigenvalue, int& free_directions) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(a);
  Vector6d step = Vector6d::Zero();
  free_directions = 0;
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] < min_eigenvalue) {
      ++free_directions;
      continue;
    }
    step -= solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(g) / solver.eigenvalues()[i]);
  }
  return step;
}

}  // namespace sweepscope
