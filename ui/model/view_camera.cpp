#include "ui/model/view_camera.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kViewAngle_deg = 30;
constexpr double kRoom = 1.08;  // of a fitted view, about the box

struct Axes {
  Eigen::Vector3d right, up, forward;
};

Axes axes_of(const ViewPoint& view) {
  const double turn = view.turn_deg * kRadPerDeg, tilt = view.elevation_deg * kRadPerDeg;
  const Eigen::Vector3d right(std::cos(turn), std::sin(turn), 0);
  const Eigen::Vector3d forward(-std::cos(tilt) * std::sin(turn), std::cos(tilt) * std::cos(turn),
                                -std::sin(tilt));
  return {right, right.cross(forward), forward};
}

double distance_m(const ViewPoint& view) {
  return view.height_m / 2 / std::tan(kViewAngle_deg / 2 * kRadPerDeg);
}

/// Moved so far to the right and up, in the view's plane.
ViewPoint shifted(ViewPoint view, double right_m, double up_m) {
  const Axes axes = axes_of(view);
  view.centre_m += right_m * axes.right + up_m * axes.up;
  return view;
}

}  // namespace

Camera camera_of(const ViewPoint& view, bool perspective) {
  const Axes axes = axes_of(view);
  Camera camera;
  camera.looks_at_m = view.centre_m;
  // An orthographic picture does not depend on the distance, as long as nothing lies behind the camera.
  camera.position_m = view.centre_m - (perspective ? distance_m(view) : 1000.0) * axes.forward;
  camera.up = axes.up;
  camera.orthographic = !perspective;
  camera.view_height_m = view.height_m;
  camera.view_angle_deg = kViewAngle_deg;
  return camera;
}

Projection projection_of(const ViewPoint& view, bool perspective, const PixelRect& pane) {
  return {camera_of(view, perspective), pane};
}

Eigen::Vector3d place_under(PixelPoint pixel, const ViewPoint& view, const PixelRect& pane) {
  const double metres_per_px = view.height_m / std::max(pane.height, 1.0);
  return shifted(view, metres_per_px * (pixel.x - pane.left - pane.width / 2),
                 -metres_per_px * (pixel.y - pane.top - pane.height / 2))
      .centre_m;
}

ViewPoint fitted(ViewPoint view, const Box& box, const PictureShape& shape, bool perspective) {
  const Axes axes = axes_of(view);
  const Eigen::Vector3d half_m = (box.to_m - box.from_m) / 2;
  const double per_depth = perspective ? std::tan(kViewAngle_deg / 2 * kRadPerDeg) : 0;
  // Fractions of the picture that are free: all of its width above the close-up, or all of its height
  // beside it. In perspective a corner needs the more room the nearer it is.
  const auto height_for = [&](double free_width, double free_height) {
    double half_height_m = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                 (corner & 4) != 0 ? 1 : -1);
      const Eigen::Vector3d at_m = half_m.cwiseProduct(sign);
      const double across_m = std::abs(at_m.dot(axes.right)) / (shape.aspect * free_width),
                   upwards_m = std::abs(at_m.dot(axes.up)) / free_height;
      half_height_m =
          std::max(half_height_m, kRoom * std::max(across_m, upwards_m) - per_depth * at_m.dot(axes.forward));
    }
    return 2 * half_height_m;
  };
  const double above_m = height_for(1, 1 - shape.covered_height),
               beside_m = height_for(1 - shape.covered_width, 1);
  view.height_m = std::max(std::min(above_m, beside_m), 0.5);
  const double right_m = beside_m < above_m ? shape.covered_width / 2 * view.height_m * shape.aspect : 0,
               down_m = beside_m < above_m ? 0 : shape.covered_height / 2 * view.height_m;
  view.centre_m = box.middle_m() + right_m * axes.right - down_m * axes.up;
  for (double* metre : {&view.centre_m.x(), &view.centre_m.y(), &view.centre_m.z(), &view.height_m})
    *metre = std::round(*metre * 100) / 100;
  return view;
}

double spare_height(const ViewPoint& view, const Box& box, double aspect) {
  const Axes axes = axes_of(view);
  const Eigen::Vector3d size_m = box.to_m - box.from_m;
  const double width_m = size_m.dot(axes.right.cwiseAbs()), height_m = size_m.dot(axes.up.cwiseAbs());
  return std::max(0.0, 1 - aspect * height_m / std::max(width_m, 1e-9) / kRoom);
}

ViewPoint turned(ViewPoint view, double right_px, double down_px) {
  constexpr double kDegPerPx = 0.35;
  view.turn_deg = std::remainder(view.turn_deg - kDegPerPx * right_px, 360);
  view.elevation_deg = std::clamp(view.elevation_deg + kDegPerPx * down_px, -90.0, 90.0);
  return view;
}

ViewPoint moved(const ViewPoint& view, double right_px, double down_px, double pane_height_px) {
  const double metres_per_px = view.height_m / std::max(pane_height_px, 1.0);
  return shifted(view, -right_px * metres_per_px, down_px * metres_per_px);
}

ViewPoint zoomed(ViewPoint view, double factor, PixelPoint at, const PixelRect& pane) {
  const double before = view.height_m / std::max(pane.height, 1.0);
  view.height_m = std::clamp(view.height_m / factor, 0.02, 1e4);
  const double gained = before - view.height_m / std::max(pane.height, 1.0);
  return shifted(view, gained * (at.x - pane.left - pane.width / 2),
                 -gained * (at.y - pane.top - pane.height / 2));
}

}  // namespace sweepscope::ui
