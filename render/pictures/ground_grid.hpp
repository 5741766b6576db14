#pragma once

#include "render/drawing/drawing.hpp"
#include "render/pictures/camera.hpp"

namespace sweepscope {

/// A level grid at round coordinates of the map frame, drawn below the points.
struct GroundGrid {
  double z_m = 0, step_m = 1;
  Eigen::Vector2d from_m{0, 0}, to_m{1, 1};  // multiples of the step
  double line_px = 1, text_px = 12;
  Colour lines, text;
};

/// The grid that holds the box, at its lower face, with steps of at least `min_step_px` in the middle of the
/// view. Its colours and sizes are left to the caller.
GroundGrid ground_grid(const Box& box, const Projection& projection, double min_step_px);

/// Its lines, and their coordinates in metres beyond the two edges that are nearest to the camera; of two
/// labels that would overlap, one. Nothing where it is seen from the side or from below.
Drawing grid_marks(const GroundGrid& grid, const Camera& camera, const Projection& projection);

}  // namespace sweepscope
