#pragma once

// The mathematics: docs/rig.md.

#include <span>
#include <vector>

#include "core/rig_solve/plane_cells.hpp"

namespace sweepscope {

/// Cells on one plane, such as those of a wall. A wide surface shows best that something bends it.
struct Surface {
  std::vector<std::uint32_t> cells;  // indices, the one with most points first
  Eigen::Vector3d centre_m, normal;  // the mean of its points, and the unit normal of their plane
};

/// Groups cells whose centres and corners lie within `reach_m` of one plane, the largest first.
/// Every cell belongs to one surface.
std::vector<Surface> surfaces_of(std::span<const PlaneCell> cells, double reach_m);

}  // namespace sweepscope
