#pragma once

#include <optional>

#include "app/recording_options.hpp"
#include "core/campaign/campaign.hpp"
#include "core/offset/estimate_options.hpp"

namespace sweepscope::app {

/// Reads only a sample of a large file of a stationary rig. None if the rig moved, or if the whole file is to
/// be read anyway.
Result<std::optional<DatedEstimate>> estimate_from_parts(const RecordingOptions& input,
                                                         const EstimateOptions& search, const Job& job);

/// Reads a recording and finds its offset. An interrupted estimate says so in `interrupted`, or is an error.
Result<DatedEstimate> estimate_recording(const RecordingOptions& input, const EstimateOptions& search,
                                         const Job& job);

}  // namespace sweepscope::app
