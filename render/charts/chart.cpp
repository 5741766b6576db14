#include "render/charts/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/charts/chart_layout.hpp"
#include "render/drawing/drawing.hpp"

namespace sweepscope {
namespace {

/// What each step of drawing a chart needs.
struct Canvas {
  Drawing& drawing;
  const Chart& chart;
  const Style& style;
  const ChartLayout& layout;
  double scale;

  bool shows(double x) const { return layout.x.contains(x); }
  PixelPoint px(double x, double y) const { return {layout.x_px(x), layout.y_px(y)}; }
};

Colour with_alpha(Colour colour, std::uint8_t alpha) {
  colour.alpha = alpha;
  return colour;
}

PolygonMark marker_of(MarkerShape shape, PixelPoint at, double radius_px, Colour colour) {
  // Corners of equal area, so that no shape stands out; a triangle's is about its centre of mass.
  int corners = 24;
  double turn = 0, reach = radius_px;
  if (shape == MarkerShape::kSquare) corners = 4, turn = M_PI / 4, reach *= 1.25;
  if (shape == MarkerShape::kDiamond) corners = 4, reach *= 1.25;
  if (shape == MarkerShape::kTriangle) corners = 3, turn = -M_PI / 2, reach *= 1.55;
  PolygonMark mark{{}, colour};
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 2 * M_PI * i / corners;
    mark.points.push_back({at.x + reach * std::cos(angle), at.y + reach * std::sin(angle)});
  }
  return mark;
}

void add_text(const Canvas& c, PixelPoint at, const std::string& text, AlignX align_x, AlignY align_y) {
  c.drawing.add(TextMark{at, text, c.layout.text_size_px(), c.style.faint_text, align_x, align_y});
}

void add_axes(const Canvas& c) {
  const PixelRect& plot = c.layout.plot;
  const Ticks &xs = c.layout.x_ticks, &ys = c.layout.y_ticks;
  for (std::size_t i = 0; i < ys.values.size(); ++i) {
    const double y = c.layout.y_px(ys.values[i]);
    const bool zero = c.chart.with_zero && ys.values[i] == 0;
    c.drawing.line({plot.left, y}, {plot.right(), y}, c.scale, zero ? c.style.faint_text : c.style.grid);
    add_text(c, {plot.left - 8 * c.scale, y}, ys.labels[i], AlignX::kRight, AlignY::kMiddle);
  }
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double x = c.layout.x_px(xs.values[i]);
    c.drawing.line({x, plot.top}, {x, plot.bottom()}, c.scale, c.style.grid);
    add_text(c, {x, plot.bottom() + 8 * c.scale}, xs.labels[i], AlignX::kCentre, AlignY::kTop);
  }
  add_text(c, {plot.left + plot.width / 2, plot.bottom() + 28 * c.scale},
           fit_text(c.chart.x_title, c.layout.text_size_px(), plot.width), AlignX::kCentre, AlignY::kTop);
}

void add_bands(const Canvas& c) {
  const PixelRect& plot = c.layout.plot;
  for (const ChartBand& band : c.chart.bands) {
    const double from = std::max(plot.left, c.layout.x_px(band.from)),
                 to = std::min(plot.right(), c.layout.x_px(band.to));
    if (from < to) c.drawing.fill({from, plot.top, to - from, plot.height}, with_alpha(band.colour, 56));
  }
  for (const ChartBand& band : c.chart.y_bands) {
    const double top = std::max(plot.top, c.layout.y_px(band.to)),
                 bottom = std::min(plot.bottom(), c.layout.y_px(band.from));
    if (top < bottom) c.drawing.fill({plot.left, top, plot.width, bottom - top}, with_alpha(band.colour, 56));
  }
}

LineMark line_of(const Canvas& c, const ChartSeries& series) {
  if (series.dashed) return {{}, 1.5 * c.scale, series.colour, 4 * c.scale};
  return {{}, 2 * c.scale, series.colour};
}

/// The stretches of a series between its gaps, in pixels.
std::vector<std::vector<PixelPoint>> stretches_of(const Canvas& c, const ChartSeries& series) {
  std::vector<std::vector<PixelPoint>> stretches(1);
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (series.y[i]) {
      stretches.back().push_back(c.px(series.x[i], *series.y[i]));
    } else if (!stretches.back().empty()) {
      stretches.emplace_back();
    }
  }
  if (stretches.back().empty()) stretches.pop_back();
  return stretches;
}

void add_area(const Canvas& c, const ChartSeries& series) {
  const double base = std::clamp(c.layout.y_px(0), c.layout.plot.top, c.layout.plot.bottom());
  for (auto& stretch : stretches_of(c, series)) {
    if (stretch.size() > 1) c.drawing.add(AreaMark{std::move(stretch), base, with_alpha(series.colour, 56)});
  }
}

/// Points that lie close get smaller shapes, or, on a line beside other series, a shape now and then. Of
/// single points beside other series each is shown.
void add_shapes(const Canvas& c, const ChartSeries& series, const std::vector<PixelPoint>& stretch,
                bool beside_others) {
  const double radius = 3.2 * c.scale;
  const auto gap_px = [&](std::size_t i) { return std::abs(stretch[i].x - stretch[i - 1].x); };
  PixelPoint last{-std::numeric_limits<double>::max(), 0};
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    if (stretch[i].x < c.layout.plot.left - 0.5 || stretch[i].x > c.layout.plot.right() + 0.5) continue;
    double fitting = radius;
    if (beside_others && series.joined) {
      if (std::hypot(stretch[i].x - last.x, stretch[i].y - last.y) < 4 * radius) continue;
      last = stretch[i];
    } else if (!beside_others) {
      if (i > 0) fitting = std::min(fitting, 0.36 * gap_px(i));
      if (i + 1 < stretch.size()) fitting = std::min(fitting, 0.36 * gap_px(i + 1));
    }
    c.drawing.add(marker_of(series.marker, stretch[i], std::max(fitting, 1.3 * c.scale), series.colour));
  }
}

void add_bars(const Canvas& c, const ChartSeries& series) {
  const double half_cap = 3 * c.scale;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.half_bars.size()); ++i) {
    if (!series.y[i] || !c.shows(series.x[i])) continue;
    const PixelPoint low = c.px(series.x[i], *series.y[i] - series.half_bars[i]),
                     high = c.px(series.x[i], *series.y[i] + series.half_bars[i]);
    c.drawing.line(low, high, 1.5 * c.scale, series.colour);
    for (const PixelPoint end : {low, high})
      c.drawing.line({end.x - half_cap, end.y}, {end.x + half_cap, end.y}, 1.5 * c.scale, series.colour);
  }
}

/// The parts of a stretch that lie in the plot: of all of it, unless only a part of the axis is shown.
std::vector<std::vector<PixelPoint>> shown_parts(const Canvas& c, std::vector<PixelPoint> stretch) {
  if (!c.chart.x_range) return {std::move(stretch)};
  std::vector<std::vector<PixelPoint>> parts;
  bool goes_on = false;
  for (std::size_t i = 1; i < stretch.size(); ++i) {
    const auto inside = clip(stretch[i - 1], stretch[i], c.layout.plot);
    if (inside && !goes_on) parts.push_back({inside->first});
    if (inside) parts.back().push_back(inside->second);
    goes_on = inside && inside->second.x == stretch[i].x && inside->second.y == stretch[i].y;
  }
  return parts;
}

void add_series(const Canvas& c, const ChartSeries& series, bool beside_others) {
  for (auto& stretch : stretches_of(c, series)) {
    if (series.marker != MarkerShape::kNone) add_shapes(c, series, stretch, beside_others);
    if (!series.joined) continue;
    for (auto& part : shown_parts(c, std::move(stretch))) {
      LineMark line = line_of(c, series);
      line.points = std::move(part);
      if (line.points.size() > 1) c.drawing.add(std::move(line));
    }
  }
  add_bars(c, series);
  const double bottom = c.layout.plot.bottom();
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double x = c.layout.x_px(series.x[i]);
    if (!series.y[i] && c.shows(series.x[i]))
      c.drawing.line({x, bottom - 7 * c.scale}, {x, bottom}, 2 * c.scale, series.colour);
  }
}

void add_all_series(const Canvas& c) {
  const auto has_shapes = [](const ChartSeries& series) { return series.marker != MarkerShape::kNone; };
  const bool beside_others = std::count_if(c.chart.series.begin(), c.chart.series.end(), has_shapes) > 1;
  for (const ChartSeries& series : c.chart.series) add_series(c, series, beside_others);
}

void add_verticals(const Canvas& c) {
  const PixelRect& plot = c.layout.plot;
  for (const ChartVertical& vertical : c.chart.verticals) {
    if (!c.shows(vertical.x)) continue;
    const double x = c.layout.x_px(vertical.x);
    if (vertical.dashed) {
      c.drawing.dashed({x, plot.top}, {x, plot.bottom()}, 5 * c.scale, 1.5 * c.scale, vertical.colour);
    } else {
      c.drawing.line({x, plot.top}, {x, plot.bottom()}, 2 * c.scale, vertical.colour);
    }
  }
}

void add_heading(const Canvas& c) {
  const ChartLayout& layout = c.layout;
  c.drawing.add(TextMark{{layout.title_place.left, layout.title_place.top + layout.title_size_px()},
                         layout.title,
                         layout.title_size_px(),
                         c.style.text});
  for (const LegendEntry& entry : layout.legend) {
    const double baseline = entry.place.top + layout.title_size_px();
    const double y = baseline - 0.35 * layout.text_size_px(), left = entry.place.left,
                 width = layout.symbol_width_px();
    const PixelPoint middle{left + width / 2, y};
    if (entry.series == nullptr) {
      c.drawing.line({middle.x, y - 4 * c.scale}, {middle.x, y + 4 * c.scale}, 2 * c.scale, c.style.curve);
    } else {
      LineMark line = line_of(c, *entry.series);
      line.points = {{left, y}, {left + width, y}};
      if (entry.series->filled) c.drawing.fill({left, y, width, 5 * c.scale}, with_alpha(line.colour, 56));
      c.drawing.add(std::move(line));
      if (entry.series->marker != MarkerShape::kNone)
        c.drawing.add(marker_of(entry.series->marker, middle, 3.6 * c.scale, entry.series->colour));
    }
    c.drawing.add(TextMark{
        {left + width + 8 * c.scale, baseline}, entry.name, layout.text_size_px(), c.style.faint_text});
  }
  for (const VerticalLabel& label : layout.labels) {
    c.drawing.add(
        TextMark{{label.place.left + label.place.width / 2, label.place.top + layout.label_size_px()},
                 label.text,
                 layout.label_size_px(),
                 label.vertical->colour,
                 AlignX::kCentre,
                 AlignY::kBaseline,
                 true});
  }
}

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

/// How much a label there would hide or lie upon.
int clutter(const Canvas& c, const PixelRect& place, const std::vector<PixelRect>& taken) {
  const PixelRect& plot = c.layout.plot;
  int count = 0;
  for (const ChartSeries& series : c.chart.series) {
    for (const auto& stretch : stretches_of(c, series)) {
      for (std::size_t i = 1; i < stretch.size(); ++i)
        count += clip(stretch[i - 1], stretch[i], place) ? 1 : 0;
    }
  }
  for (const ChartVertical& vertical : c.chart.verticals) {
    const double x = c.layout.x_px(vertical.x);
    count += clip({x, plot.top}, {x, plot.bottom()}, place) ? 1 : 0;
  }
  for (const PixelRect& other : taken) count += overlap(place, other) ? 100 : 0;
  if (!plot.contains({place.left, place.top}) || !plot.contains({place.right(), place.bottom()}))
    count += 1000;
  return count;
}

/// Right or left of the bar, above or below it, or further off: the first place of the least clutter.
PixelRect place_for(const Canvas& c, const ChartSpan& span, const std::vector<PixelRect>& taken) {
  const double size = c.layout.label_size_px(), gap = 8 * c.scale, height = size + 6 * c.scale;
  const double width = text_width_px(span.label, size, true) + 6 * c.scale;
  const PixelPoint from = c.px(span.from, span.y), to = c.px(span.to, span.y);
  const double middle = (from.x + to.x - width) / 2, y = from.y - height / 2;
  PixelRect best{to.x + gap, y, width, height};
  int fewest = std::numeric_limits<int>::max();
  for (const double off : {0.0, 2.0, 4.0, 7.0, 11.0}) {
    for (const PixelPoint at :
         {PixelPoint{to.x + gap + off * gap, y}, PixelPoint{from.x - gap - off * gap - width, y},
          PixelPoint{middle, from.y - gap / 2 - off * gap - height},
          PixelPoint{middle, from.y + gap / 2 + off * gap}}) {
      const PixelRect place{at.x, at.y, width, height};
      const int count = clutter(c, place, taken);
      if (count < fewest) fewest = count, best = place;
    }
  }
  return best;
}

void add_spans(const Canvas& c) {
  std::vector<PixelRect> taken;
  const double cap = 5 * c.scale;
  for (const ChartSpan& span : c.chart.spans) {
    const PixelPoint from = c.px(span.from, span.y), to = c.px(span.to, span.y);
    taken.push_back({from.x, from.y - cap, to.x - from.x, 2 * cap});
  }
  for (const ChartSpan& span : c.chart.spans) {
    const PixelPoint from = c.px(span.from, span.y), to = c.px(span.to, span.y);
    c.drawing.line(from, to, 2 * c.scale, span.colour);
    for (const PixelPoint end : {from, to})
      c.drawing.line({end.x, end.y - cap}, {end.x, end.y + cap}, 2 * c.scale, span.colour);
    if (span.label.empty()) continue;
    const PixelRect place = place_for(c, span, taken);
    taken.push_back(place);
    c.drawing.fill(place, with_alpha(c.style.panel, 190));
    c.drawing.add(TextMark{{place.left + place.width / 2, place.top + place.height / 2},
                           span.label,
                           c.layout.label_size_px(),
                           span.colour,
                           AlignX::kCentre,
                           AlignY::kMiddle,
                           true});
  }
}

void add_markers(const Canvas& c) {
  for (const ChartMarker& marker : c.chart.markers) {
    if (!c.shows(marker.x)) continue;
    const PixelPoint at = c.px(marker.x, marker.y);
    c.drawing.add(marker_of(marker.shape, at, 6.2 * c.scale, c.style.panel));
    c.drawing.add(marker_of(marker.shape, at, 5 * c.scale, marker.colour));
  }
}

}  // namespace

std::vector<ChartReading> read_chart(const Chart& chart, double x) {
  std::vector<ChartReading> readings;
  const auto nearest_to = [&](const ChartSeries& series, double wanted) -> std::optional<ChartReading> {
    std::optional<ChartReading> best;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!series.y[i] || (chart.x_range && !chart.x_range->contains(series.x[i]))) continue;
      if (!best || std::abs(series.x[i] - wanted) < std::abs(best->x - wanted))
        best = ChartReading{&series, series.x[i], *series.y[i]};
    }
    return best;
  };
  for (const ChartSeries& series : chart.series) {
    if (series.marker == MarkerShape::kNone) continue;
    const auto reading = nearest_to(series, readings.empty() ? x : readings.front().x);
    if (reading && (readings.empty() || reading->x == readings.front().x)) readings.push_back(*reading);
  }
  return readings;
}

void add_chart(Drawing& drawing, const PixelRect& place, const Chart& chart, const Style& style,
               double scale) {
  const ChartLayout layout = lay_out_chart(chart, place, scale);
  const Canvas canvas{drawing, chart, style, layout, scale};
  drawing.fill(layout.plot, style.panel);
  add_bands(canvas);
  add_axes(canvas);
  add_heading(canvas);
  for (const ChartSeries& series : chart.series) {
    if (series.filled) add_area(canvas, series);
  }
  add_verticals(canvas);
  add_all_series(canvas);
  add_spans(canvas);
  add_markers(canvas);
  drawing.frame(layout.plot, scale, style.frame);
}

}  // namespace sweepscope
