#pragma once

#include "core/error.hpp"
#include "core/offset/estimate.hpp"
#include "render/charts/chart.hpp"

namespace sweepscope {

/// The offset over time: each window's with a bar of one sigma to either side, a tick on the axis where a
/// window does not determine it, and the course as a line that breaks at its jumps. An estimate without
/// windows is ExitCode::kWrongUsage.
Result<Chart> over_time_chart(const Estimate& estimate, const Style& style);

}  // namespace sweepscope
