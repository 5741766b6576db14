#pragma once

#include <Eigen/Core>

#include "render/drawing/drawing.hpp"
#include "render/pictures/camera.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The camera of a view point.
Camera camera_of(const ViewPoint& view, bool perspective);

/// Projects positions of the map frame into a pane.
Projection projection_of(const ViewPoint& view, bool perspective, const PixelRect& pane);
/// The inverse: the position under a pixel at the depth of the view's centre.
Eigen::Vector3d place_under(PixelPoint pixel, const ViewPoint& view, const PixelRect& pane);

/// The shape of a map's picture, and what a close-up covers of its lower right corner.
struct PictureShape {
  double aspect = 1;                             // width over height
  double covered_width = 0, covered_height = 0;  // fractions of the picture's; 0: nothing

  bool operator==(const PictureShape&) const = default;
};

/// The view from the same direction that shows the whole box with a small margin, above or beside what is
/// covered. In whole centimetres.
ViewPoint fitted(ViewPoint view, const Box& box, const PictureShape& shape, bool perspective = false);
/// The fraction of the picture's height that stays free where the box fills its width; 0 where it does not.
double spare_height(const ViewPoint& view, const Box& box, double aspect);

/// The view after dragging by a number of pixels: turned, or moved with the mouse.
ViewPoint turned(ViewPoint view, double right_px, double down_px);
ViewPoint moved(const ViewPoint& view, double right_px, double down_px, double pane_height_px);
/// Zoomed in by a factor; the position under the pixel does not move.
ViewPoint zoomed(ViewPoint view, double factor, PixelPoint at, const PixelRect& pane);

}  // namespace sweepscope::ui
