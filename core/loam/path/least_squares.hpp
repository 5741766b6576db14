#pragma once

// The mathematics: docs/algorithms.md, section 2.

#include <Eigen/Core>

#include "core/geometry/pose.hpp"

namespace sweepscope {

/// Of a rotation vector in rad and a translation in m, in this order.
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A step of a pose: rotation vector (rad) about `pivot_m`, then translation (m), both in the map frame.
inline Pose stepped(const Pose& pose, const Vector6d& step, const Eigen::Vector3d& pivot_m) {
  const Eigen::Quaterniond turn = rotation_from_vector(step.head<3>());
  return {(turn * pose.rotation).normalized(),
          turn * (pose.translation_m - pivot_m) + pivot_m + step.tail<3>()};
}

/// The row of the Jacobian of a distance along `normal` at `p_m` for a step about `pivot_m`.
inline Vector6d distance_jacobian(const Eigen::Vector3d& p_m, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& pivot_m) {
  const Eigen::Vector3d turned = (p_m - pivot_m).cross(normal);
  // Not by <<, which sets three at once through a loop that is not unrolled.
  return {turned.x(), turned.y(), turned.z(), normal.x(), normal.y(), normal.z()};
}

/// Weight of a residual that a Cauchy loss of width `scale` gives.
inline double cauchy_weight(double residual, double scale) {
  const double ratio = residual / scale;
  return 1.0 / (1.0 + ratio * ratio);
}

/// Minimises x' A x / 2 + g' x. Directions whose eigenvalue is below `min_eigenvalue` are not changed: what
/// the scene does not determine keeps its value. `free_directions` counts them.
Vector6d solve_determined(const Matrix6d& a, const Vector6d& g, double min_eigenvalue, int& free_directions);

/// Normal equations of the step of a rigid pose, about the map's origin, from points at distances along
/// normals.
struct RigidEquations {
  Matrix6d matrix = Matrix6d::Zero();    // the sum of w J^T J
  Vector6d gradient = Vector6d::Zero();  // the sum of w J^T r

  /// Adds a point at the given distance from a plane with that normal.
  void add(const Eigen::Vector3d& p_m, const Eigen::Vector3d& normal, double distance_m, double weight) {
    const Vector6d row = distance_jacobian(p_m, normal, Eigen::Vector3d::Zero());
    matrix.noalias() += weight * row * row.transpose();
    gradient += weight * distance_m * row;
  }
};

}  // namespace sweepscope
