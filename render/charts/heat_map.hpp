#pragma once

#include <string>
#include <vector>

#include "render/charts/chart.hpp"

namespace sweepscope {

/// Values over two axes, as coloured cells.
struct HeatMap {
  std::string title, x_title, y_title;  // with units
  AxisRange x, y;                       // of the outer edges of the cells
  std::size_t columns = 0, rows = 0;
  std::vector<double> values;  // row by row, the row of the least y first; NaN: no value, grey
  ColourScale colours;
};

/// Draws the map with its title, axes and labels inside `place`; `scale` is 1 for letters of 13 px.
void add_heat_map(Drawing& drawing, const PixelRect& place, const HeatMap& map, const Style& style,
                  double scale);

/// The colours of a scale as a bar, the greatest value at the top, with `title` above it and labels at its
/// right.
void add_colour_bar(Drawing& drawing, const PixelRect& place, const ColourScale& colours,
                    const std::string& title, const Style& style, double scale);

}  // namespace sweepscope
