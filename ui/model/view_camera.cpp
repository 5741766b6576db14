#include "ui/model/view_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sweepscope::ui {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kViewAngle_deg = 30;

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

Projection::Projection(const ViewPoint& view, bool perspective, const PixelRect& pane)
    : pane_(pane),
      centre_m_(view.centre_m),
      metres_per_px_(view.height_m / std::max(pane.height, 1.0)),
      distance_m_(distance_m(view)),
      perspective_(perspective) {
  const Axes axes = axes_of(view);
  right_ = axes.right;
  up_ = axes.up;
  forward_ = axes.forward;
}

std::optional<PixelPoint> Projection::to_px(const Eigen::Vector3d& p_m) const {
  const Eigen::Vector3d from_centre_m = p_m - centre_m_;
  double scale = 1 / metres_per_px_;
  if (perspective_) {
    const double depth_m = distance_m_ + from_centre_m.dot(forward_);
    if (depth_m < 1e-3) return std::nullopt;
    scale *= distance_m_ / depth_m;
  }
  return PixelPoint{pane_.left + pane_.width / 2 + scale * from_centre_m.dot(right_),
                    pane_.top + pane_.height / 2 - scale * from_centre_m.dot(up_)};
}

Eigen::Vector3d Projection::under(PixelPoint pixel) const {
  return centre_m_ + metres_per_px_ * ((pixel.x - pane_.left - pane_.width / 2) * right_ -
                                       (pixel.y - pane_.top - pane_.height / 2) * up_);
}

ViewPoint turned(ViewPoint view, double right_px, double down_px) {
  constexpr double kDegPerPx = 0.35;
  view.turn_deg = std::remainder(view.turn_deg - kDegPerPx * right_px, 360);
  view.elevation_deg = std::clamp(view.elevation_deg + kDegPerPx * down_px, -90.0, 90.0);
  return view;
}

ViewPoint moved(ViewPoint view, double right_px, double down_px, double pane_height_px) {
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
