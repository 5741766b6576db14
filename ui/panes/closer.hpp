#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// The densities of both maps along the profile line.
void draw_profile_chart(const PaneContext& context, const PixelRect& place);

/// One scan in the scanner's plane with its edge and plane points, and a slider over all scans.
void draw_scan_view(const PaneContext& context, const PixelRect& place);

}  // namespace sweepscope::ui
