#pragma once

#include "ui/model/view_camera.hpp"
#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// Handles the mouse on the picture of a map; call right after the widget that covers it.
void use_mouse(const PaneContext& context, Side side, const PixelRect& picture);

/// The sensor's path, the scale bar, and the marks of the tools, above the picture of a map.
/// What lies below the points: the backdrop and the ground grid, where the view has one.
void draw_ground(const PaneContext& context, Side side, const PixelRect& picture);
void draw_overlays(const PaneContext& context, Side side, const PixelRect& picture);

/// The view of a pane on its map.
const ViewPoint& view_of(const Settings& settings, Side side);
Projection projection_of(const Settings& settings, Side side, const PixelRect& picture);

/// The scan that is played, and the sensor, over a map.
void draw_played_scan(const PaneContext& context, Side side, const Projection& projection);

}  // namespace sweepscope::ui
