#pragma once

#include <optional>

#include "app/recording_options.hpp"
#include "core/campaign/campaign.hpp"
#include "core/offset/estimate_options.hpp"

namespace sweepscope::app {

/// Of a large file of a rig that stood still only those parts are read that decide. None where the rig moved,
/// and where the file is to be read wholly anyway.
Result<std::optional<DatedEstimate>> estimate_from_parts(const RecordingOptions& input,
                                                         const EstimateOptions& search, const Job& job);

/// Reads a recording and finds its offset. An interrupted estimate says so in `interrupted`, or is an error.
Result<DatedEstimate> estimate_recording(const RecordingOptions& input, const EstimateOptions& search,
                                         const Job& job);

}  // namespace sweepscope::app
