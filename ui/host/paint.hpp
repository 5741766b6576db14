#pragma once

#include <imgui.h>

#include "render/drawing/drawing.hpp"
#include "ui/host/theme.hpp"

namespace sweepscope::ui {

/// Paints flat marks on an ImGui draw list: the same charts as in the pictures for reports. Positions are in
/// pixels of the window.
void paint(ImDrawList& list, const Drawing& drawing, const Fonts& fonts);

void paint_text(ImDrawList& list, const TextMark& mark, const Fonts& fonts);

}  // namespace sweepscope::ui
