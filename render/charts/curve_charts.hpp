#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/offset/estimate.hpp"
#include "render/charts/chart.hpp"

namespace sweepscope {

/// An offset whose map is shown, and its colour.
struct MarkedOffset {
  double offset_s = 0;
  Colour colour;
};

/// The criteria over the offset as charts: d with theta and the alternating roll (stationary), e, n and the
/// alternating roll (moving), or the capped cost of the coarse search (direct). Only criteria that
/// have a value somewhere get a chart. The marked offsets are lines across each, the offset found is a dashed
/// one in a band of its uncertainty (none without one), a criterion's own optimum is a diamond, and the
/// fit that gave it is dashed.
std::vector<Chart> curve_charts(const Estimate& estimate, std::span<const MarkedOffset> marked,
                                const Style& style);

/// One of these charts, by the criterion's name ("d", "theta", "e", "n", "roll", "capped_cost"). An unknown
/// name, or one for which the estimate has no value, is ExitCode::kWrongUsage.
Result<Chart> curve_chart(const Estimate& estimate, std::string_view criterion,
                          std::span<const MarkedOffset> marked, const Style& style);

/// An estimate beside others.
struct NamedEstimate {
  std::string name;  // in the legend
  Estimate estimate;
};

enum class Normalise { kNo, kByOptimum };

/// One criterion ("d", "theta", "e", "n", "roll", "capped_cost") of several recordings in one chart, each
/// with its name, the offset found and a larger mark at its optimum. kByOptimum divides each curve by its own
/// minimum (n: its maximum; not possible for the roll). An unknown criterion, or one for which no estimate
/// has a value, is ExitCode::kWrongUsage.
Result<Chart> curves_of_many(std::span<const NamedEstimate> estimates, std::string_view criterion,
                             const Style& style, Normalise normalise = Normalise::kNo);

/// "24.0", "24.05": milliseconds with one decimal, or as many up to three as it has.
std::string offset_label_ms(double offset_s);

}  // namespace sweepscope
