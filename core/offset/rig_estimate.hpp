#pragma once

// The mathematics: docs/rig.md.

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// The offset and the parts of the rig that the options solve for: of a rig that stood still, the rig is
/// solved for first, then the offset is estimated with it; of a walk, both in turn. For the errors see
/// `estimate`.
Result<Estimate> estimate_with_rig(const PreparedRecording& prepared, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job);

}  // namespace sweepscope
