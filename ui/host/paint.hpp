#pragma once

#include <imgui.h>

#include "render/drawing/drawing.hpp"
#include "ui/host/theme.hpp"

namespace sweepscope::ui {

/// Paints flat marks on an ImGui draw list: the same charts as in the pictures for reports. Positions are in
/// pixels of the window.
void paint(ImDrawList& list, const Drawing& drawing, const Fonts& fonts);

void paint_text(ImDrawList& list, const TextMark& mark, const Fonts& fonts);
inline void paint_text(ImDrawList& list, const Fonts& fonts, PixelPoint at, const std::string& text,
                       double size_px, const Colour& colour, AlignX align_x, AlignY align_y) {
  paint_text(list, {at, text, size_px, colour, align_x, align_y}, fonts);
}

}  // namespace sweepscope::ui
