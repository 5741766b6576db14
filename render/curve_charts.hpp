#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/offset/estimate.hpp"
#include "render/chart.hpp"

namespace sweepscope {

/// An offset whose map is shown, and the colour that stands for it.
struct MarkedOffset {
  double offset_s = 0;
  Colour colour;
};

/// The criteria over the offset as charts: d with theta and the alternating roll (stationary), or e, n and
/// the alternating roll (moving). Only criteria that have a value somewhere get a chart. The marked offsets
/// are lines across each, the offset found is a dashed one, and a criterion's own optimum is a diamond.
std::vector<Chart> curve_charts(const Estimate& estimate, std::span<const MarkedOffset> marked,
                                const Style& style);

/// "24.0", "24.05": milliseconds with one decimal, or as many up to three as it has.
std::string offset_label_ms(double offset_s);

}  // namespace sweepscope
