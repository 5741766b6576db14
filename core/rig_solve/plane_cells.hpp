#pragma once

// The mathematics: docs/algorithms.md, section 16.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace sweepscope {

struct PlaneCellOptions {
  double min_edge_m = 0.25;     // of the smallest cubes
  int levels = 4;               // the largest cubes are 2^levels as wide
  double flatness_m = 0.03;     // a surface's points lie this near to its plane (rms) ...
  double min_near = 0.9;        // ... and this fraction of them within three times that
  std::size_t min_points = 30;  // on a surface
};

/// A flat surface within a cube: which points lie on it, and its plane.
struct PlaneCell {
  std::vector<std::uint32_t> points;  // indices
  Eigen::Vector3d centre_m, normal;
  Eigen::Matrix<double, 3, 2>
      along_m;            // its points' deviations along the plane, as lengths of two directions
  double flatness_m = 0;  // and across it, robust
};

/// Cuts space into cubes until the points within each lie on one plane; those that never do, and those of too
/// few points or of a line only, are left out. The order of the cells, and of a cell's points, depends on the
/// points alone.
std::vector<PlaneCell> plane_cells(std::span<const Eigen::Vector3d> points_m,
                                   const PlaneCellOptions& options);

}  // namespace sweepscope
