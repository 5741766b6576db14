#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// The dialog that opens a recording: a path to type, with completion, and the folder that it leads to.
void draw_open_dialog(const PaneContext& context, const PixelRect& whole);

/// Where it begins: the folder of the newest recent recording, or the working folder.
std::string first_path(const std::vector<std::string>& recent);

}  // namespace sweepscope::ui
