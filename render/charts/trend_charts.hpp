#pragma once

#include <vector>

#include "core/campaign/campaign.hpp"
#include "render/charts/chart.hpp"

namespace sweepscope {

/// The offsets of a campaign over its recordings, numbered from 1 in their order, and, where at least two
/// have different dates, over the dates (UTC). Each offset has a bar of one sigma to either side; those that
/// lie outside what is expected have another shape and colour; the expected band is shaded; a recording
/// without an offset is a tick on the axis.
std::vector<Chart> trend_charts(const Campaign& campaign, const Style& style);

}  // namespace sweepscope
