#pragma once

// The mathematics: docs/rig.md.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace sweepscope {

/// What counts as a flat cell.
struct PlaneCellOptions {
  double min_edge_m = 0.25;     // of the smallest cubes
  int levels = 4;               // the largest cubes are 2^levels as wide
  double flatness_m = 0.03;     // max rms distance of a surface's points from its plane
  double min_near = 0.9;        // fraction of them within three times that
  std::size_t min_points = 30;  // on a surface
};

/// A flat surface within a cube: which points lie on it, and its plane.
struct PlaneCell {
  std::vector<std::uint32_t> points;  // indices
  Eigen::Vector3d centre_m, normal;   // the mean of its points, and the unit normal of their plane
  Eigen::Matrix<double, 3, 2>
      along_m;            // its points' deviations along the plane, as lengths of two directions
  double flatness_m = 0;  // and across it, robust
};

/// Splits space into cubes until the points of each lie on one plane. Cubes that never do, or hold too few
/// points or only a line, are left out. The order of the cells and of their points depends on the points
/// alone.
std::vector<PlaneCell> plane_cells(std::span<const Eigen::Vector3d> points_m,
                                   const PlaneCellOptions& options);

}  // namespace sweepscope
