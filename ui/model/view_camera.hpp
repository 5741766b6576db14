#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/drawing.hpp"
#include "render/picture.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The camera that a view point stands for.
Camera camera_of(const ViewPoint& view, bool perspective);

/// Where places of the map frame are in a pane, and back.
class Projection {
 public:
  Projection(const ViewPoint& view, bool perspective, const PixelRect& pane);

  /// Empty behind the camera.
  std::optional<PixelPoint> to_px(const Eigen::Vector3d& p_m) const;
  /// The place under a pixel at the depth of the view's centre.
  Eigen::Vector3d under(PixelPoint pixel) const;
  /// Of the plane through the view's centre.
  double metres_per_px() const { return metres_per_px_; }
  Eigen::Vector3d to_right() const { return right_; }
  Eigen::Vector3d to_top() const { return up_; }

 private:
  PixelRect pane_;
  Eigen::Vector3d centre_m_, right_, up_, forward_;
  double metres_per_px_ = 1, distance_m_ = 1;
  bool perspective_ = false;
};

/// The view after dragging by so many pixels: turned, or moved along with the hand.
ViewPoint turned(ViewPoint view, double right_px, double down_px);
ViewPoint moved(ViewPoint view, double right_px, double down_px, double pane_height_px);
/// Nearer by a factor, with the place under the pixel staying where it is.
ViewPoint zoomed(ViewPoint view, double factor, PixelPoint at, const PixelRect& pane);

}  // namespace sweepscope::ui
