#pragma once

#include "render/pictures/picture.hpp"
#include "ui/explorer/explorer.hpp"

namespace sweepscope::ui {

/// The maps that the layout shows (of a swipe: both) as a picture of any size, with labels, legend, scale and
/// axes, smooth edges and all points that are placed. What the panes show lies within the views;
/// `pane_aspect`: their width over height. Sizes as `compare` takes them, or ExitCode::kWrongUsage.
Result<Picture> maps_picture(const Explorer& explorer, int width_px, int height_px, double pane_aspect);

}  // namespace sweepscope::ui
