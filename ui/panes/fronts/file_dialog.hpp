#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// Whether a command's file exists already, and is asked for with the dialog below.
bool is_opening(const std::string& command);

/// The dialog that asks for a file to open: a path to type, with completion, and the folder that it leads to.
void draw_open_dialog(const PaneContext& context, const PixelRect& whole);

/// Where it begins: the folder of the newest recent recording, or the working folder.
std::string first_path(const std::vector<std::string>& recent);

}  // namespace sweepscope::ui
