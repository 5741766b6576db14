#pragma once

#include <array>
#include <string_view>

#include "render/images/colour_table.hpp"

namespace sweepscope {

/// The colours of everything that is not data, and those of the compared maps (never red against green
/// alone).
struct Style {
  Colour page, panel, frame, grid, text, faint_text, highlight;
  Colour map_panel, map_highlight;  // behind points, and marks upon them
  Colour curve, second_curve;
  std::array<Colour, 4> maps;
};

inline constexpr Style kDarkStyle{
    .page = {20, 23, 28},
    .panel = {9, 11, 14},
    .frame = {48, 55, 65},
    .grid = {35, 41, 49},
    .text = {232, 235, 240},
    .faint_text = {150, 160, 174},
    .highlight = {255, 255, 255},
    .map_panel = {9, 11, 14},
    .map_highlight = {255, 255, 255},
    .curve = {214, 220, 229},
    .second_curve = {128, 146, 178},
    .maps = {{{242, 180, 41}, {92, 192, 248}, {229, 138, 192}, {120, 214, 170}}},
};

inline constexpr Style kLightStyle{
    .page = {255, 255, 255},
    .panel = {246, 247, 249},
    .frame = {190, 197, 207},
    .grid = {224, 228, 233},
    .text = {26, 30, 36},
    .faint_text = {92, 101, 114},
    .highlight = {0, 0, 0},
    .map_panel = {9, 11, 14},  // colour tables end in yellow, which vanishes on white
    .map_highlight = {255, 255, 255},
    .curve = {38, 44, 53},
    .second_curve = {104, 122, 156},
    .maps = {{{190, 120, 0}, {0, 114, 178}, {183, 78, 141}, {0, 138, 100}}},
};

/// The same without dark panels.
constexpr Style white_style() {
  Style style = kLightStyle;
  style.panel = {255, 255, 255};
  style.map_panel = {255, 255, 255};
  style.map_highlight = {0, 0, 0};
  return style;
}

/// For a page of any light colour.
constexpr Style transparent_style() {
  Style style = white_style();
  style.page.alpha = style.panel.alpha = style.map_panel.alpha = 0;
  return style;
}

enum class Background { kDark, kLight, kWhite, kTransparent };

inline constexpr std::array<std::string_view, 4> kBackgroundNames{"dark", "light", "white", "transparent"};

constexpr Style style_of(Background background) {
  switch (background) {
    case Background::kLight:
      return kLightStyle;
    case Background::kWhite:
      return white_style();
    case Background::kTransparent:
      return transparent_style();
    case Background::kDark:
      break;
  }
  return kDarkStyle;
}

}  // namespace sweepscope
