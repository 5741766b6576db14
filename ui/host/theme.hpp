#pragma once

#include <imgui.h>

#include <array>

#include "render/drawing/style.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The fonts of the interface, in several sizes.
struct Fonts {
  struct Sized {
    ImFont* font = nullptr;
    double em_px = 0;
    bool bold = false;
  };
  std::array<Sized, 8> all;
  ImFont* small = nullptr;
  ImFont* body = nullptr;
  ImFont* bold = nullptr;
  ImFont* heading = nullptr;  // of panels
  ImFont* title = nullptr;

  /// The baked font nearest to a size; `em_px` of it is nearly that.
  const Sized& nearest(double em_px, bool bold) const;
};

/// Fills the atlas of the current ImGui context with the fonts inside the program, for a display's scale.
Fonts load_fonts(double scale);

const Style& style_of(Theme theme);
ImU32 to_imgui(Colour colour);
ImU32 to_imgui(Colour colour, double opacity);

/// Colours, margins and corners of the current ImGui context.
void apply_theme(const Style& style, double scale);

/// The colours of map A and map B everywhere.
inline Colour colour_of_a(const Style& style) {
  return style.maps[0];
}
inline Colour colour_of_b(const Style& style) {
  return style.maps[1];
}

}  // namespace sweepscope::ui
