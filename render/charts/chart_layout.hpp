#pragma once

#include <string>
#include <vector>

#include "render/charts/chart.hpp"
#include "render/charts/ticks.hpp"

namespace sweepscope {

/// A series' symbol and name, or those of absent values.
struct LegendEntry {
  const ChartSeries* series = nullptr;  // none: absent values
  std::string name;
  PixelRect place;  // the symbol at its left, the name after it
};

/// The label of a vertical line.
struct VerticalLabel {
  const ChartVertical* vertical = nullptr;
  std::string text;
  PixelRect place;
};

/// The positions of everything in a chart. Title, legend, labels and plot never overlap.
struct ChartLayout {
  double scale = 1;
  std::string title;
  PixelRect title_place;
  std::vector<LegendEntry> legend;
  std::vector<VerticalLabel> labels;
  PixelRect plot;
  AxisRange x, y;
  Ticks x_ticks, y_ticks;

  double x_px(double value) const { return plot.left + (value - x.from) / (x.to - x.from) * plot.width; }
  double y_px(double value) const { return plot.bottom() - (value - y.from) / (y.to - y.from) * plot.height; }
  double title_size_px() const { return 15 * scale; }
  double text_size_px() const { return 13 * scale; }
  double label_size_px() const { return 12.5 * scale; }
  double symbol_width_px() const { return 22 * scale; }
};

/// The chart must outlive its layout.
ChartLayout lay_out_chart(const Chart& chart, const PixelRect& place, double scale);

}  // namespace sweepscope
