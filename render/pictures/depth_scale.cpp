#include "render/pictures/depth_scale.hpp"

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <array>
#include <cmath>

#include "core/numbers.hpp"

namespace sweepscope {

DepthScale depth_scale(vtkRenderer& renderer, const Camera& camera, double view_height_px) {
  std::array<double, 2> range_m{};
  renderer.GetActiveCamera()->GetClippingRange(range_m.data());
  return {camera.orthographic, range_m[0], range_m[1], camera.view_height_m / view_height_px,
          pixels_per_metre(camera, view_height_px)};
}

double pixels_per_metre(const Camera& camera, double view_height_px) {
  if (camera.orthographic) return view_height_px / camera.view_height_m;
  return view_height_px / 2 / std::tan(camera.view_angle_deg / 2 * kRadPerDeg);
}

}  // namespace sweepscope
