#include "ui/panes/layout.hpp"

#include <algorithm>
#include <cmath>

#include "ui/model/places.hpp"

namespace sweepscope::ui {
namespace {

/// Whole pixels, or pictures would be blurred.
PixelRect snapped(const PixelRect& rect) {
  const double left = std::round(rect.left), top = std::round(rect.top);
  return {left, top, std::max(0.0, std::round(rect.right()) - left),
          std::max(0.0, std::round(rect.bottom()) - top)};
}

/// The size that a person gave, or the one by the window, within what leaves room for the rest.
double size_px(double given_px, double by_window_px, double scale, double least_px, double greatest_px) {
  const double wanted_px = given_px > 0 ? given_px * scale : by_window_px;
  return given_px > 0 ? std::clamp(wanted_px, least_px, std::max(least_px, greatest_px)) : wanted_px;
}

}  // namespace

Places lay_out(double width_px, double height_px, double scale, const Settings& settings, bool has_recording,
               double message_px) {
  const double menu = 30 * scale, status = 28 * scale;
  // As in serve.css, for the page's buttons.
  const bool wide = width_px > 940 * scale && height_px > 420 * scale;
  const bool panels = settings.panels && has_recording && wide;
  const double tabs = has_recording && !wide ? 44 * scale : 0;
  const double widest = 0.36 * width_px;
  const double left = panels ? size_px(settings.left_width_px, std::min(292 * scale, 0.26 * width_px), scale,
                                       160 * scale, widest)
                             : 0;
  const double right = panels ? size_px(settings.right_width_px, std::min(244 * scale, 0.24 * width_px),
                                        scale, 160 * scale, widest)
                              : 0;
  const double middle = height_px - menu - status - tabs;
  const bool criteria = settings.criteria && has_recording && middle > 240 * scale;
  const double min_charts = std::min(190 * scale, 0.42 * middle);
  const double charts =
      criteria ? size_px(settings.charts_height_px, std::clamp(0.29 * middle, min_charts, 300 * scale), scale,
                         std::min(120 * scale, min_charts), (wide ? 0.65 : 0.45) * middle)
               : 0;
  const double playback = has_recording && settings.time_s >= 0 ? 34 * scale : 0;
  // A message takes its place from the charts, so that the maps keep their size as long as charts remain.
  const double charts_beside_message = std::max(charts - message_px, std::min(charts, 120 * scale));
  const double below = message_px > 0 ? message_px + charts_beside_message : charts;
  const double above_message = height_px - status - message_px, above_tabs = above_message - tabs;
  Places places;
  places.menu = snapped({0, 0, width_px, menu});
  places.status = snapped({0, height_px - status, width_px, status});
  places.message = snapped({0, above_message, width_px, message_px});
  places.left = snapped({0, menu, left, above_message - menu});
  places.right = snapped({width_px - right, menu, right, above_message - menu});
  places.maps = snapped({left, menu, width_px - left - right, middle - below - playback});
  places.playback = snapped({left, places.maps.bottom(), width_px - left - right, playback});
  places.criteria =
      snapped({left, height_px - status - tabs - below, width_px - left - right, below - message_px});
  places.tabs = snapped({0, above_tabs, width_px, tabs});
  if (tabs > 0 && settings.sheet != Sheet::kNone)
    places.sheet = snapped({0, menu, width_px < 520 * scale ? width_px : 360 * scale, above_tabs - menu});
  return places;
}

MapPlaces lay_out_maps(const PixelRect& maps, double scale, Layout layout, double share) {
  const double margin = 10 * scale, header = 34 * scale;
  const PixelRect inner{maps.left + margin, maps.top, maps.width - 2 * margin, maps.height - margin};
  const bool beside = layout == Layout::kSideBySide, stacked = layout == Layout::kStacked;
  MapPlaces places;
  const auto pane = [&](const PixelRect& place, PixelRect& above, PixelRect& picture) {
    above = snapped({place.left, place.top, place.width, header});
    picture = snapped({place.left, place.top + header, place.width, place.height - header});
  };
  PixelRect a = inner, b = inner;
  if (beside) {
    a.width = (inner.width - margin) * share;
    b = {a.right() + margin, inner.top, inner.width - margin - a.width, inner.height};
  } else if (stacked) {
    a.height = inner.height * share;
    b = {inner.left, a.bottom(), inner.width, inner.height - a.height};
  }
  if (layout != Layout::kOnlyB && layout != Layout::kDifference) pane(a, places.header_a, places.picture_a);
  if (layout != Layout::kOnlyA) pane(b, places.header_b, places.picture_b);
  return places;
}

Layout shown_layout(Layout wanted, const PixelRect& maps, double scale) {
  const bool as_a_phone = maps.width < 480 * scale && maps.height > 0.9 * maps.width;
  return wanted == Layout::kSideBySide && as_a_phone ? Layout::kStacked : wanted;
}

std::vector<PixelRect> close_up_places(const PixelRect& picture, double scale, Layout layout,
                                       double spare_height) {
  constexpr double kMinWidth = 100, kMaxWidth = 420, kGap = 8;  // at 100 %
  constexpr double kMaxSpare = 0.6;
  const bool both = layout == Layout::kSwipe;
  const double gap = kGap * scale;
  const double spare = both ? 0 : std::min(spare_height, kMaxSpare) - 2 * gap / std::max(picture.height, 1.0);
  const double high = std::max(both ? 0.32 : 0.42, spare);
  const double share = both ? 0.3 : high > 0.42 ? 1 - 2 * gap / std::max(picture.width, 1.0) : 0.44;
  const double width =
      std::min({share * picture.width, high * picture.height * PlaceToLook::kAspect, kMaxWidth * scale});
  if (width < kMinWidth * scale) return {};
  const double height = width / PlaceToLook::kAspect;
  std::vector<PixelRect> places;
  for (int i = both ? 1 : 0; i >= 0; --i)
    places.push_back(
        snapped({picture.right() - (i + 1) * (width + gap), picture.bottom() - height - gap, width, height}));
  return places;
}

}  // namespace sweepscope::ui
