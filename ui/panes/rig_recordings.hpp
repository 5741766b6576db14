#pragma once

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// The list of the recordings of one rig, and what each says where they were estimated together; nothing
/// without a list.
void draw_rig_recordings(const PaneContext& context);

}  // namespace sweepscope::ui
