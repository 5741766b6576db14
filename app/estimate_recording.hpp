#pragma once

#include "app/recording_options.hpp"
#include "core/campaign/campaign.hpp"
#include "core/offset/estimate_options.hpp"

namespace sweepscope::app {

/// Reads a recording, as far as its estimate goes by it, and finds its offset. An interrupted estimate says
/// so in `interrupted`, or is an error.
Result<DatedEstimate> estimate_recording(const RecordingOptions& input, const EstimateOptions& search,
                                         const Job& job);

}  // namespace sweepscope::app
