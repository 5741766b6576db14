#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// Whether the estimate that the charts show has the offset in windows.
bool has_windows(const PaneContext& context);

/// The offset of each window over time, with the course through them; the window under the mouse says what it
/// found, or why nothing.
void draw_over_time_strip(const PaneContext& context, const PixelRect& place);

}  // namespace sweepscope::ui
