#pragma once

#include <Eigen/Core>

#include "render/drawing.hpp"
#include "render/picture.hpp"

namespace sweepscope {

/// A map seen from above in a part of a picture: which place is at which pixel, and the camera that makes it
/// so.
struct TopView {
  PixelRect place;
  Eigen::Vector2d centre_m{0, 0};  // x and y of the map frame in the middle
  double metres_per_px = 0.01;
  bool turned = false;  // false: x to the right and y up; true: y to the right and x down

  PixelPoint to_px(double x_m, double y_m) const {
    const double dx = (x_m - centre_m.x()) / metres_per_px, dy = (y_m - centre_m.y()) / metres_per_px;
    const double middle_x = place.left + place.width / 2, middle_y = place.top + place.height / 2;
    return turned ? PixelPoint{middle_x + dy, middle_y + dx} : PixelPoint{middle_x + dx, middle_y - dy};
  }

  /// Half of the view's extent along x and y of the map frame.
  Eigen::Vector2d half_extent_m() const {
    const Eigen::Vector2d half(place.width * metres_per_px / 2, place.height * metres_per_px / 2);
    return turned ? Eigen::Vector2d(half.y(), half.x()) : half;
  }

  Camera camera() const {
    constexpr double kHeight_m = 1000;  // above everything; an orthographic picture does not depend on it
    Camera camera;
    camera.position_m = {centre_m.x(), centre_m.y(), kHeight_m};
    camera.looks_at_m = {centre_m.x(), centre_m.y(), 0};
    camera.up = turned ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(0, 1, 0);
    camera.view_height_m = place.height * metres_per_px;
    return camera;
  }
};

}  // namespace sweepscope
