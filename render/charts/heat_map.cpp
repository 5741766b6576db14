#include "render/charts/heat_map.hpp"

#include <algorithm>
#include <cmath>

#include "render/charts/ticks.hpp"

namespace sweepscope {
namespace {

/// The cells' part of the place: labels of numbers at its left, those and a title below, a title above.
PixelRect plot_of(const PixelRect& place, double scale) {
  const double left = std::round(44 * scale), top = std::round(44 * scale), below = std::round(42 * scale);
  return {place.left + left, place.top + top, std::floor(place.width - left),
          std::floor(place.height - top - below)};
}

void add_cells(Drawing& drawing, const PixelRect& plot, const HeatMap& map) {
  // Edges on whole pixels leave no seams between the cells.
  const auto x_px = [&](std::size_t column) {
    return std::round(plot.left +
                      plot.width * static_cast<double>(column) / static_cast<double>(map.columns));
  };
  const auto y_px = [&](std::size_t row) {
    return std::round(plot.bottom() - plot.height * static_cast<double>(row) / static_cast<double>(map.rows));
  };
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double value = map.values[row * map.columns + column];
      if (std::isnan(value)) continue;
      drawing.fill({x_px(column), y_px(row + 1), x_px(column + 1) - x_px(column), y_px(row) - y_px(row + 1)},
                   map.colours.at(value));
    }
}

void add_axes(Drawing& drawing, const PixelRect& plot, const HeatMap& map, const Style& style, double scale) {
  const double size = 11 * scale, gap = 6 * scale;
  const Ticks xs =
      round_ticks(map.x.from, map.x.to, std::max(2, static_cast<int>(plot.width / (56 * scale))));
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double x = plot.left + (xs.values[i] - map.x.from) / map.x.length() * plot.width;
    drawing.line({x, plot.bottom()}, {x, plot.bottom() + 3 * scale}, scale, style.frame);
    drawing.add(TextMark{
        {x, plot.bottom() + gap}, xs.labels[i], size, style.faint_text, AlignX::kCentre, AlignY::kTop});
  }
  const Ticks ys =
      round_ticks(map.y.from, map.y.to, std::max(2, static_cast<int>(plot.height / (40 * scale))));
  for (std::size_t i = 0; i < ys.values.size(); ++i) {
    const double y = plot.bottom() - (ys.values[i] - map.y.from) / map.y.length() * plot.height;
    drawing.line({plot.left - 3 * scale, y}, {plot.left, y}, scale, style.frame);
    drawing.add(TextMark{
        {plot.left - gap, y}, ys.labels[i], size, style.faint_text, AlignX::kRight, AlignY::kMiddle});
  }
  drawing.add(TextMark{{plot.left + plot.width / 2, plot.bottom() + gap + 1.5 * size},
                       map.x_title,
                       size,
                       style.text,
                       AlignX::kCentre,
                       AlignY::kTop});
  drawing.add(TextMark{{plot.left, plot.top - gap}, map.y_title, size, style.text});
}

}  // namespace

void add_heat_map(Drawing& drawing, const PixelRect& place, const HeatMap& map, const Style& style,
                  double scale) {
  const PixelRect plot = plot_of(place, scale);
  drawing.fill(plot, style.frame);  // where no value is: unlike the middle of a diverging table
  add_cells(drawing, plot, map);
  add_axes(drawing, plot, map, style, scale);
  drawing.frame(plot, scale, style.frame);
  drawing.add(TextMark{{plot.left, place.top + 14 * scale},
                       fit_text(map.title, 14 * scale, plot.width, true),
                       14 * scale,
                       style.text,
                       AlignX::kLeft,
                       AlignY::kBaseline,
                       true});
}

void add_colour_bar(Drawing& drawing, const PixelRect& place, const ColourScale& colours,
                    const std::string& title, const Style& style, double scale) {
  constexpr int kSteps = 64;
  const double size = 11 * scale;
  const auto y_px = [&](int step) { return std::round(place.bottom() - place.height * step / kSteps); };
  for (int step = 0; step < kSteps; ++step) {
    const double value = std::lerp(colours.from, colours.to, (step + 0.5) / kSteps);
    drawing.fill({place.left, y_px(step + 1), place.width, y_px(step) - y_px(step + 1)}, colours.at(value));
  }
  drawing.frame(place, scale, style.frame);
  const Ticks ticks =
      round_ticks(colours.from, colours.to, std::max(2, static_cast<int>(place.height / (36 * scale))));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double share = (ticks.values[i] - colours.from) / (colours.to - colours.from);
    drawing.add(TextMark{{place.right() + 5 * scale, place.bottom() - share * place.height},
                         ticks.labels[i],
                         size,
                         style.faint_text,
                         AlignX::kLeft,
                         AlignY::kMiddle});
  }
  drawing.add(TextMark{{place.left, place.top - 6 * scale}, title, size, style.text});
}

}  // namespace sweepscope
