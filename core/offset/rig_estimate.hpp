#pragma once

// The mathematics: docs/rig.md.

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// The offset and the parts of the rig that the options solve for: for a stationary rig, the rig is solved
/// for first, then the offset is estimated with it; for a walk, both in turn. For the errors see `estimate`.
Result<Estimate> estimate_with_rig(const RecordingSource& source, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job);

}  // namespace sweepscope
