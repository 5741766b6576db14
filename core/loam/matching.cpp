#include "core/loam/matching.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace sweepscope {
namespace {

struct Spread {
  Eigen::Vector3d mean_m;
  Eigen::Vector3d eigenvalues_m2;  // ascending
  Eigen::Matrix3d eigenvectors;
};

Spread spread_of(const Neighbours& neighbours) {
  // Relative to the first neighbour: far from the map's origin squares would lose the digits that matter.
  const Eigen::Vector3d origin = neighbours.p_m[0].cast<double>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int i = 1; i < neighbours.count; ++i) {
    const Eigen::Vector3d d = neighbours.p_m[i].cast<double>() - origin;
    sum += d;
    squares.noalias() += d * d.transpose();
  }
  const double n = neighbours.count;
  const Eigen::Vector3d mean = sum / n;
  const Eigen::Matrix3d covariance = squares / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return {origin + mean, solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

std::optional<PlanePatch> fit_plane(const Neighbours& neighbours, const PatchOptions& options,
                                    double radius_m) {
  if (neighbours.count < 5 || neighbours.lines < options.least_lines) return std::nullopt;
  const Spread spread = spread_of(neighbours);
  const double thickness_m = options.thickness_m + options.thickness_slope * radius_m;
  const double flat = spread.eigenvalues_m2[0], wide = spread.eigenvalues_m2[1];
  if (!(flat < thickness_m * thickness_m) || !(wide > 4 * flat) || !(wide > 0.02 * spread.eigenvalues_m2[2]))
    return std::nullopt;
  return PlanePatch{spread.mean_m, spread.eigenvectors.col(0)};
}

std::optional<LinePatch> fit_line(const Neighbours& neighbours, const PatchOptions& options,
                                  double radius_m) {
  if (neighbours.count < 4 || neighbours.lines < options.least_edge_lines) return std::nullopt;
  const Spread spread = spread_of(neighbours);
  const double thickness_m = options.thickness_m + options.thickness_slope * radius_m;
  if (!(spread.eigenvalues_m2[1] < thickness_m * thickness_m) ||
      !(spread.eigenvalues_m2[2] > 3 * spread.eigenvalues_m2[1]))
    return std::nullopt;
  return LinePatch{spread.mean_m, spread.eigenvectors.col(2)};
}

}  // namespace sweepscope
