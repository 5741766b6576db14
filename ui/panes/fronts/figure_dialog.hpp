#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// What the dialog of `export-figure` has beside the file: a preview, the size and the parts of the figure,
/// and its file's type.
void draw_figure_options(const PaneContext& context);

/// The line that writes it.
std::string figure_line(const Transient& transient, const std::string& file);

}  // namespace sweepscope::ui
