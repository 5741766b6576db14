#pragma once

#include "render/chart.hpp"

namespace sweepscope::ui {

/// Where a chart's plot is and which offsets its sides stand for: what dragging in it needs.
struct ChartAxes {
  PixelRect plot;
  double from = 0, to = 1;

  double to_px(double value) const { return plot.left + (value - from) / (to - from) * plot.width; }
  double to_value(double px) const { return from + (px - plot.left) / plot.width * (to - from); }
};

ChartAxes axes_of(const Chart& chart, const PixelRect& place, const Style& style, double scale);

}  // namespace sweepscope::ui
