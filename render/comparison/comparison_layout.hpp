#pragma once

#include <cstddef>
#include <vector>

#include "render/comparison/comparison.hpp"
#include "render/drawing/drawing.hpp"

namespace sweepscope {

/// The positions of everything in a comparison. Unused ones are empty.
struct ComparisonLayout {
  double scale = 1;  // of letters and lines; 1 at 1920 x 1200
  double margin = 0;
  PixelPoint title, subtitle, footer;  // baselines
  std::vector<PixelPoint> labels;      // of the maps
  std::vector<PixelRect> overviews, close_ups;
  PixelRect scalar_bar;  // the bar itself, without its numbers
  std::vector<PixelRect> charts;
};

/// `charts` is the number of charts side by side at the bottom; with 0 the maps take all the space.
ComparisonLayout lay_out(const ComparisonOptions& options, std::size_t maps, std::size_t charts);

}  // namespace sweepscope
