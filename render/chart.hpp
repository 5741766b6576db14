#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/drawing.hpp"
#include "render/style.hpp"

namespace sweepscope {

struct ChartSeries {
  std::string name;  // in the legend
  std::vector<double> x;
  std::vector<std::optional<double>> y;  // absent values leave a gap
  Colour colour;
};

/// A vertical line across the chart with a label above it.
struct ChartVertical {
  double x = 0;
  std::string label;
  Colour colour;
  bool dashed = false;
};

struct ChartMarker {
  double x = 0, y = 0;
  Colour colour;
};

/// A chart of lines as data. Axes fit what there is; `with_zero` widens y to hold 0 and draws a line there.
struct Chart {
  std::string title;    // what y is, with its unit
  std::string x_title;  // what x is, with its unit
  std::vector<ChartSeries> series;
  std::vector<ChartVertical> verticals;
  std::vector<ChartMarker> markers;
  bool with_zero = false;
};

/// Draws the chart with its title and labels inside `place`; `scale` is 1 for a picture of 1920 x 1200.
void add_chart(Drawing& drawing, const PixelRect& place, const Chart& chart, const Style& style,
               double scale);

}  // namespace sweepscope
