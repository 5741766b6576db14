#pragma once

#include <Eigen/Core>

#include "render/drawing/drawing.hpp"
#include "render/pictures/camera.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The camera that a view point stands for.
Camera camera_of(const ViewPoint& view, bool perspective);

/// Where places of the map frame are in a pane.
Projection projection_of(const ViewPoint& view, bool perspective, const PixelRect& pane);
/// And back: the place under a pixel at the depth of the view's centre.
Eigen::Vector3d place_under(PixelPoint pixel, const ViewPoint& view, const PixelRect& pane);

/// The view from the same direction that shows the whole box and little more, in a pane of that aspect (width
/// over height). In whole centimetres.
ViewPoint fitted(ViewPoint view, const Box& box, double aspect);

/// The view after dragging by so many pixels: turned, or moved along with the hand.
ViewPoint turned(ViewPoint view, double right_px, double down_px);
ViewPoint moved(ViewPoint view, double right_px, double down_px, double pane_height_px);
/// Nearer by a factor, with the place under the pixel staying where it is.
ViewPoint zoomed(ViewPoint view, double factor, PixelPoint at, const PixelRect& pane);

}  // namespace sweepscope::ui
