#include "render/charts/chart_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ranges>

namespace sweepscope {
namespace {

class Extent {
 public:
  void include(double value) {
    from_ = std::min(from_, value);
    to_ = std::max(to_, value);
  }
  bool is_empty() const { return from_ > to_; }
  /// With room at both ends; but an end at 0 stays there where `keeps_zero`.
  AxisRange padded(double fraction, bool keeps_zero) const {
    if (is_empty()) return {};
    const double min_padding = std::max(std::abs(from_), 1e-9) * 1e-3;  // a flat curve still gets an axis
    const double padding = std::max((to_ - from_) * fraction, min_padding);
    return {keeps_zero && from_ == 0 ? 0 : from_ - padding, keeps_zero && to_ == 0 ? 0 : to_ + padding};
  }

 private:
  double from_ = std::numeric_limits<double>::max(), to_ = std::numeric_limits<double>::lowest();
};

AxisRange range_of_x(const Chart& chart) {
  if (chart.x_range) return *chart.x_range;
  Extent extent;
  for (const ChartSeries& series : chart.series) {
    for (const double x : series.x) {
      extent.include(chart.x_counts ? x - 0.5 : x);
      extent.include(chart.x_counts ? x + 0.5 : x);
    }
  }
  for (const ChartVertical& vertical : chart.verticals) extent.include(vertical.x);
  return extent.padded(0.04, false);
}

/// Where the line from a point to the next one meets the ends of what is shown.
void include_crossings(Extent& extent, const ChartSeries& series, std::size_t i, const AxisRange& shown) {
  if (i + 1 >= series.y.size() || !series.y[i] || !series.y[i + 1]) return;
  const double from = series.x[i], to = series.x[i + 1];
  for (const double end : {shown.from, shown.to}) {
    if ((end - from) * (end - to) >= 0) continue;
    extent.include(*series.y[i] + (end - from) / (to - from) * (*series.y[i + 1] - *series.y[i]));
  }
}

void include_shown(Extent& extent, const ChartSeries& series, const AxisRange& shown) {
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    if (series.joined) include_crossings(extent, series, i, shown);
    if (!series.y[i] || !shown.contains(series.x[i])) continue;
    const double half = i < series.half_bars.size() ? series.half_bars[i] : 0;
    extent.include(*series.y[i] - half);
    extent.include(*series.y[i] + half);
  }
}

/// Nothing without a value.
std::optional<AxisRange> range_of_y(const Chart& chart, const AxisRange& shown) {
  Extent extent;
  bool with_zero = chart.with_zero;
  for (const ChartSeries& series : chart.series) {
    include_shown(extent, series, shown);
    with_zero |= series.filled;
  }
  for (const ChartMarker& marker : chart.markers)
    if (shown.contains(marker.x)) extent.include(marker.y);
  for (const ChartSpan& span : chart.spans) extent.include(span.y);
  for (const ChartBand& band : chart.y_bands) {
    extent.include(band.from);
    extent.include(band.to);
  }
  if (with_zero) extent.include(0);
  if (extent.is_empty()) return std::nullopt;
  return extent.padded(0.08, with_zero);
}

double widest(const Ticks& ticks, double size_px) {
  double width = 0;
  for (const std::string& label : ticks.labels) width = std::max(width, text_width_px(label, size_px));
  return width;
}

/// As many ticks as have room for their labels beside each other.
Ticks ticks_along(const Chart& chart, const AxisRange& range, double length_px, double size_px) {
  Ticks ticks;
  // A step of 1 follows from this many, and none below it.
  const double max_count = chart.x_counts ? std::ceil(range.to - range.from) : length_px;
  for (int count = std::max(2, static_cast<int>(std::min(length_px / (3.5 * size_px), max_count))); count > 0;
       --count) {
    ticks = chart.x_dates_from_s ? date_ticks(range.from, range.to, count, *chart.x_dates_from_s)
                                 : round_ticks(range.from, range.to, count);
    const double step_px = ticks.step / (range.to - range.from) * length_px;
    if (widest(ticks, size_px) + size_px <= step_px) break;
  }
  return ticks;
}

bool has_absent(const Chart& chart) {
  const auto is_absent = [](const auto& y) { return !y.has_value(); };
  return std::any_of(chart.series.begin(), chart.series.end(), [&](const ChartSeries& series) {
    return std::any_of(series.y.begin(), series.y.end(), is_absent);
  });
}

/// The entries with their widths, not yet in place. A single one says nothing: none.
std::vector<LegendEntry> legend_of(const Chart& chart, const ChartLayout& layout, double room_px) {
  std::vector<LegendEntry> legend;
  const double before_name = layout.symbol_width_px() + 8 * layout.scale;
  const auto add = [&](const ChartSeries* series, const std::string& name) {
    if (name.empty()) return;
    const double size = layout.text_size_px();
    const std::string shown = fit_text(name, size, room_px - before_name);
    legend.push_back({series, shown, {0, 0, before_name + text_width_px(shown, size), 1.2 * size}});
  };
  for (const ChartSeries& series : chart.series) add(&series, series.name);
  if (has_absent(chart)) add(nullptr, chart.absent_name);
  if (legend.size() < 2) legend.clear();
  return legend;
}

/// Puts title and legend at the top: in one row where there is room, else the legend in rows below.
/// Returns where the next row begins.
double place_heading(const Chart& chart, const PixelRect& place, ChartLayout& layout) {
  const double s = layout.scale, row = 20 * s, gap = 20 * s;
  layout.title = fit_text(chart.title, layout.title_size_px(), place.width);
  layout.title_place = {place.left, place.top, text_width_px(layout.title, layout.title_size_px()), row};
  layout.legend = legend_of(chart, layout, place.width);
  double legend_width = 0;
  for (const LegendEntry& entry : layout.legend) legend_width += entry.place.width + gap;
  const bool beside = layout.title_place.width + legend_width <= place.width;
  double x = beside ? place.right() - legend_width + gap : place.left, y = place.top;
  if (!beside) y += row + 2 * s;
  for (LegendEntry& entry : layout.legend) {
    if (x > place.left && x + entry.place.width > place.right() + 1e-6) x = place.left, y += row;
    entry.place.left = x;
    entry.place.top = y;
    x += entry.place.width + gap;
  }
  return y + row;
}

constexpr double kLabelGap = 10;  // between the labels of verticals, at 100 %

/// The labels of the verticals by x, those beyond the plot's width cut. Where lines coincide, in their order.
std::vector<VerticalLabel> labels_of(const Chart& chart, const ChartLayout& layout, double room_px) {
  std::vector<VerticalLabel> labels;
  const auto column = [&](const ChartVertical& vertical) {
    return std::floor((vertical.x - layout.x.from) / layout.x.length() * room_px / 2);
  };
  for (const ChartVertical& vertical : chart.verticals) {
    if (vertical.label.empty() || !layout.x.contains(vertical.x)) continue;
    const std::string text = fit_text(vertical.label, layout.label_size_px(), room_px, true);
    const double width = text_width_px(text, layout.label_size_px(), true);
    labels.push_back({&vertical, text, {0, 0, width, 14 * layout.scale}});
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [&](const auto& a, const auto& b) { return column(*a.vertical) < column(*b.vertical); });
  return labels;
}

/// How many rows the labels need so that those of a row (every rows-th) fit beside each other.
std::size_t rows_for(const std::vector<VerticalLabel>& labels, double room_px, double gap) {
  for (std::size_t rows = 1; rows < labels.size(); ++rows) {
    std::vector<double> widths(rows, -gap);
    for (std::size_t i = 0; i < labels.size(); ++i) widths[i % rows] += labels[i].place.width + gap;
    if (*std::max_element(widths.begin(), widths.end()) <= room_px) return rows;
  }
  return labels.size();
}

/// Centres each label of one row above its line, or beside its neighbour where they would overlap.
void place_row(const std::vector<VerticalLabel*>& row, const ChartLayout& layout, double gap) {
  double min_left = layout.plot.left;
  for (VerticalLabel* label : row) {
    label->place.left = std::max(layout.x_px(label->vertical->x) - label->place.width / 2, min_left);
    min_left = label->place.right() + gap;
  }
  double max_right = layout.plot.right();
  for (VerticalLabel* label : row | std::views::reverse) {
    label->place.left = std::min(label->place.left, max_right - label->place.width);
    max_right = label->place.left - gap;
  }
}

void place_labels(ChartLayout& layout, std::size_t rows, double top, double row_height) {
  const double gap = kLabelGap * layout.scale;
  for (std::size_t r = 0; r < rows; ++r) {
    std::vector<VerticalLabel*> row;
    for (std::size_t i = r; i < layout.labels.size(); i += rows) row.push_back(&layout.labels[i]);
    for (VerticalLabel* label : row) label->place.top = top + static_cast<double>(rows - 1 - r) * row_height;
    place_row(row, layout, gap);
  }
}

}  // namespace

ChartLayout lay_out_chart(const Chart& chart, const PixelRect& place, double scale) {
  ChartLayout layout;
  layout.scale = scale;
  layout.x = range_of_x(chart);
  const std::optional<AxisRange> y = range_of_y(chart, layout.x);
  layout.y = y.value_or(AxisRange());
  const double size = layout.text_size_px(), below = 46 * scale, label_row = 16 * scale;
  const double labels_top = place_heading(chart, place, layout) + 8 * scale;
  layout.labels = labels_of(chart, layout, 0.8 * place.width);
  // Rows are counted before the plot's width is known: the axis' labels take a fifth at most.
  const std::size_t rows = rows_for(layout.labels, 0.8 * place.width, kLabelGap * scale);
  layout.plot.top = labels_top + static_cast<double>(rows) * label_row + (rows > 0 ? 4 * scale : 0);
  layout.plot.height = std::max(1.0, place.bottom() - below - layout.plot.top);
  if (y)
    layout.y_ticks =
        round_ticks(y->from, y->to, std::max(2, static_cast<int>(layout.plot.height / (32 * scale))));
  // Without values as much room as these will need.
  const double labels_px = y ? widest(layout.y_ticks, size) : text_width_px("000", size);
  layout.plot.left = place.left + std::min(labels_px + 12 * scale, 0.2 * place.width);
  layout.plot.width = place.right() - layout.plot.left;
  layout.x_ticks = ticks_along(chart, layout.x, layout.plot.width, size);
  if (!layout.x_ticks.values.empty()) {  // the last tick's label stays inside too
    const double end =
        layout.x_px(layout.x_ticks.values.back()) + text_width_px(layout.x_ticks.labels.back(), size) / 2;
    layout.plot.width -= std::max(0.0, end - place.right());
  }
  place_labels(layout, rows, labels_top, label_row);
  return layout;
}

}  // namespace sweepscope
