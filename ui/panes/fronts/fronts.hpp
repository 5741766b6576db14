#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// Begins a window in front of everything, with a veil over the rest; ImGui::End ends it. Sizes at 100 %.
void begin_front(const PaneContext& context, const char* name, const PixelRect& whole, double width,
                 double height, double from_top = 0.16);

}  // namespace sweepscope::ui
