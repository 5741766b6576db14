#include "core/map/consistency/weakest_direction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace sweepscope {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void FacedSurfaces::add(const Vector3d& arm_m, const Vector3d& normal, double distance_m) {
  constexpr double kLoss_m = 0.05;  // as the narrow loss of match_views
  const double weight = cauchy_weight(distance_m, kLoss_m);
  equations_.add(arm_m, normal, distance_m, weight);
  faces_.push_back({normal, weight});
}

WeakestDirection FacedSurfaces::weakest() const {
  // The normals of floors and of walls along the way scatter, and so seem to show a little of any motion, the
  // more the more of them there are. Below this cosine a surface does not show it.
  constexpr double kMinFacing = 0.5;
  constexpr double kPrior = 1e-2;  // of a match at 1 m: the matrix is then regular
  const Matrix6d& all = equations_.matrix;
  const Matrix3d turns = all.topLeftCorner<3, 3>() + kPrior * Matrix3d::Identity();
  const Matrix3d mixed = all.topRightCorner<3, 3>();
  const Matrix3d shifts = all.bottomRightCorner<3, 3>() - mixed.transpose() * turns.ldlt().solve(mixed);
  WeakestDirection weakest;
  weakest.direction = Eigen::SelfAdjointEigenSolver<Matrix3d>(shifts).eigenvectors().col(0);
  for (const Face& face : faces_) {
    const double cosine = face.normal.dot(weakest.direction);
    if (std::abs(cosine) > kMinFacing) weakest.facing += face.weight * cosine * cosine;
  }
  return weakest;
}

}  // namespace sweepscope
