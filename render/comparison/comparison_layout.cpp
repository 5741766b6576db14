#include "render/comparison/comparison_layout.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

/// Equal parts beside each other, on whole pixels.
std::vector<PixelRect> columns(const PixelRect& place, std::size_t count, double gap) {
  const double parts = static_cast<double>(count);
  const double width = std::floor((place.width - gap * (parts - 1)) / parts);
  std::vector<PixelRect> rects;
  for (std::size_t i = 0; i < count; ++i) {
    rects.push_back({place.left + static_cast<double>(i) * (width + gap), place.top, width, place.height});
  }
  return rects;
}

/// The maps' places: beside each other, or four maps alone two by two.
std::vector<PixelRect> map_places(const PixelRect& row, std::size_t maps, double gap, double label_room,
                                  bool with_close_up) {
  if (maps < 4 || with_close_up) return columns(row, maps, gap);
  PixelRect half = row;
  half.height = std::floor((row.height - label_room) / 2);
  std::vector<PixelRect> places = columns(half, (maps + 1) / 2, gap);
  half.top += half.height + label_room;
  for (const PixelRect& place : columns(half, maps / 2, gap)) places.push_back(place);
  return places;
}

}  // namespace

ComparisonLayout lay_out(const ComparisonOptions& options, std::size_t maps, std::size_t charts) {
  const double width = options.width_px, height = options.height_px;
  ComparisonLayout out;
  // Letters are as large as the room allows: a picture with fewer rows has more of it.
  const double full_height = 700 + (options.with_close_up ? 300 : 0) + (charts > 0 ? 200 : 0);
  const double s = out.scale = std::clamp(std::min(width / 1920, height / full_height), 0.4, 4.0);
  const auto px = [s](double at_full_size) { return std::round(at_full_size * s); };
  const double margin = out.margin = px(32), gap = px(20);
  out.title = {margin, px(48)};
  out.subtitle = {margin, px(74)};
  out.footer = {margin, height - px(22)};

  const double scalar_bar_room = px(86), charts_room = charts > 0 ? std::round(height * 0.25) : 0;
  const double maps_bottom = height - px(56) - charts_room - (charts > 0 ? px(30) : 0);
  PixelRect room{margin, px(126), width - 2 * margin - scalar_bar_room, 0};
  room.height = maps_bottom - room.top;
  PixelRect row = room;
  if (options.with_close_up) row.height = std::floor((room.height - gap) / 2);
  out.overviews = map_places(row, maps, gap, px(46), options.with_close_up);
  if (options.with_close_up) {
    row.top += row.height + gap;
    out.close_ups = columns(row, maps, gap);
  }
  for (const PixelRect& overview : out.overviews)
    out.labels.push_back({overview.left, overview.top - px(12)});
  const double bar_height = std::min(row.height, px(380));
  out.scalar_bar = {width - margin - scalar_bar_room + gap, room.top + px(38), px(16), bar_height - px(38)};
  if (charts > 0) {
    out.charts = columns({margin, maps_bottom + px(30), width - 2 * margin, charts_room}, charts, px(56));
  }
  return out;
}

}  // namespace sweepscope
