#pragma once

// The mathematics: docs/algorithms.md, section 16.

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// The offset beside the parts of the rig that the options solve for: the rig is solved for first, and the
/// recording with that rig gives the offset. A rig that moved is refused. For the errors see estimate.
Result<Estimate> estimate_with_rig(const PreparedRecording& prepared, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job);

}  // namespace sweepscope
