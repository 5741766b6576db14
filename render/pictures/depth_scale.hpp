#pragma once

#include "render/images/eye_dome.hpp"
#include "render/pictures/camera.hpp"

class vtkRenderer;

namespace sweepscope {

/// What the depths mean that a renderer draws with this camera, in a view of that height.
DepthScale depth_scale(vtkRenderer& renderer, const Camera& camera, double view_height_px);

/// Pixels per metre in a parallel projection; in perspective those at a distance of 1 m.
double pixels_per_metre(const Camera& camera, double view_height_px);

}  // namespace sweepscope
