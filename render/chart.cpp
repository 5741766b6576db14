#include "render/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/ticks.hpp"

namespace sweepscope {
namespace {

struct Range {
  double from = std::numeric_limits<double>::max(), to = std::numeric_limits<double>::lowest();

  void include(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
  void pad(double fraction) {
    if (from > to) from = to = 0;
    const double least = std::max(std::abs(from), 1e-9) * 1e-3;  // a flat curve still gets an axis
    const double padding = std::max((to - from) * fraction, least);
    from -= padding;
    to += padding;
  }
};

/// What each step of drawing a chart needs.
struct Frame {
  Drawing& drawing;
  const Chart& chart;
  const Style& style;
  double scale;
  PixelRect plot;
  Range x, y;

  double px(double value) const { return plot.left + (value - x.from) / (x.to - x.from) * plot.width; }
  double py(double value) const { return plot.bottom() - (value - y.from) / (y.to - y.from) * plot.height; }
  double label_px() const { return 13 * scale; }
};

Range range_of_x(const Chart& chart) {
  Range range;
  for (const ChartSeries& series : chart.series) {
    for (const double x : series.x) range.include(x);
  }
  for (const ChartVertical& vertical : chart.verticals) range.include(vertical.x);
  range.pad(0.04);
  return range;
}

Range range_of_y(const Chart& chart) {
  Range range;
  for (const ChartSeries& series : chart.series) {
    for (const auto& y : series.y) {
      if (y) range.include(*y);
    }
  }
  for (const ChartMarker& marker : chart.markers) range.include(marker.y);
  if (chart.with_zero) range.include(0);
  range.pad(0.08);
  return range;
}

void add_axes(const Frame& f) {
  f.drawing.fill(f.plot, f.style.panel);
  const Ticks ys =
      round_ticks(f.y.from, f.y.to, std::max(2, static_cast<int>(f.plot.height / (38 * f.scale))));
  for (std::size_t i = 0; i < ys.values.size(); ++i) {
    const double y = f.py(ys.values[i]);
    const bool zero = f.chart.with_zero && ys.values[i] == 0;
    f.drawing.line({f.plot.left, y}, {f.plot.right(), y}, f.scale, zero ? f.style.faint_text : f.style.grid);
    f.drawing.add(TextMark{{f.plot.left - 8 * f.scale, y},
                           ys.labels[i],
                           f.label_px(),
                           f.style.faint_text,
                           AlignX::kRight,
                           AlignY::kMiddle});
  }
  const Ticks xs =
      round_ticks(f.x.from, f.x.to, std::max(2, static_cast<int>(f.plot.width / (46 * f.scale))));
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double x = f.px(xs.values[i]);
    f.drawing.line({x, f.plot.top}, {x, f.plot.bottom()}, f.scale, f.style.grid);
    f.drawing.add(TextMark{{x, f.plot.bottom() + 8 * f.scale},
                           xs.labels[i],
                           f.label_px(),
                           f.style.faint_text,
                           AlignX::kCentre,
                           AlignY::kTop});
  }
  f.drawing.add(TextMark{{f.plot.left + f.plot.width / 2, f.plot.bottom() + 28 * f.scale},
                         f.chart.x_title,
                         f.label_px(),
                         f.style.faint_text,
                         AlignX::kCentre,
                         AlignY::kTop});
}

void add_title_and_legend(const Frame& f, const PixelRect& place) {
  const double size = 15 * f.scale, baseline = place.top + size;
  f.drawing.add(TextMark{{place.left, baseline}, f.chart.title, size, f.style.text});
  if (f.chart.series.size() < 2) return;
  double right = place.right();
  for (auto series = f.chart.series.rbegin(); series != f.chart.series.rend(); ++series) {
    f.drawing.add(
        TextMark{{right, baseline}, series->name, f.label_px(), f.style.faint_text, AlignX::kRight});
    right -= text_width_px(series->name, f.label_px()) + 8 * f.scale;
    const double y = baseline - 0.35 * f.label_px();
    f.drawing.line({right - 22 * f.scale, y}, {right, y}, 2 * f.scale, series->colour);
    right -= 42 * f.scale;
  }
}

void add_series(const Frame& f, const ChartSeries& series) {
  LineMark line{{}, 2 * f.scale, series.colour};
  const auto finish = [&] {
    if (line.points.size() > 1) f.drawing.add(line);
    line.points.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!series.y[i]) {
      finish();
      continue;
    }
    const PixelPoint at{f.px(series.x[i]), f.py(*series.y[i])};
    line.points.push_back(at);
    // A dot where a value was computed, as long as dots stay apart; then a lone value between gaps shows too.
    const double r =
        (static_cast<double>(series.x.size()) * 9 * f.scale < f.plot.width ? 3.0 : 1.0) * f.scale;
    f.drawing.add(
        PolygonMark{{{at.x - r, at.y}, {at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}}, series.colour});
  }
  finish();
}

/// Where each vertical's label is centred: above its line, or beside its neighbour where they would overlap.
std::vector<double> label_centres(const Frame& f, const std::vector<const ChartVertical*>& sorted,
                                  double size) {
  std::vector<double> centres, half;
  const double gap = 6 * f.scale;
  for (const ChartVertical* vertical : sorted) {
    half.push_back(text_width_px(vertical->label, size, true) / 2);
    const double least = centres.empty() ? f.plot.left + half.back()
                                         : centres.back() + half[half.size() - 2] + gap + half.back();
    centres.push_back(std::max(f.px(vertical->x), least));
  }
  double limit = f.plot.right();
  for (std::size_t i = centres.size(); i-- > 0;) {
    centres[i] = std::min(centres[i], limit - half[i]);
    limit = centres[i] - half[i] - gap;
  }
  return centres;
}

void add_verticals(const Frame& f) {
  std::vector<const ChartVertical*> sorted;
  for (const ChartVertical& vertical : f.chart.verticals) {
    const double x = f.px(vertical.x);
    if (vertical.dashed) {
      f.drawing.dashed({x, f.plot.top}, {x, f.plot.bottom()}, 5 * f.scale, 1.5 * f.scale, vertical.colour);
    } else {
      f.drawing.line({x, f.plot.top}, {x, f.plot.bottom()}, 2 * f.scale, vertical.colour);
    }
    if (!vertical.label.empty()) sorted.push_back(&vertical);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->x < b->x; });
  const double size = 12.5 * f.scale;
  const auto centres = label_centres(f, sorted, size);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    f.drawing.add(TextMark{{centres[i], f.plot.top - 6 * f.scale},
                           sorted[i]->label,
                           size,
                           sorted[i]->colour,
                           AlignX::kCentre,
                           AlignY::kBaseline,
                           true});
  }
}

void add_markers(const Frame& f) {
  for (const ChartMarker& marker : f.chart.markers) {
    const double x = f.px(marker.x), y = f.py(marker.y);
    for (const auto& [r, colour] :
         {std::pair{8 * f.scale, f.style.panel}, std::pair{6 * f.scale, marker.colour}}) {
      f.drawing.add(PolygonMark{{{x - r, y}, {x, y - r}, {x + r, y}, {x, y + r}}, colour});
    }
  }
}

}  // namespace

void add_chart(Drawing& drawing, const PixelRect& place, const Chart& chart, const Style& style,
               double scale) {
  const Range x = range_of_x(chart), y = range_of_y(chart);
  const Ticks ys = round_ticks(y.from, y.to, std::max(2, static_cast<int>(place.height / (50 * scale))));
  double widest = 0;
  for (const std::string& label : ys.labels) widest = std::max(widest, text_width_px(label, 13 * scale));
  const double left = place.left + widest + 12 * scale, top = place.top + 48 * scale;
  const PixelRect plot{left, top, place.right() - left, place.bottom() - 46 * scale - top};
  const Frame frame{drawing, chart, style, scale, plot, x, y};
  add_axes(frame);
  add_title_and_legend(frame, place);
  add_verticals(frame);
  for (const ChartSeries& series : chart.series) add_series(frame, series);
  add_markers(frame);
  drawing.frame(plot, scale, style.frame);
}

}  // namespace sweepscope
