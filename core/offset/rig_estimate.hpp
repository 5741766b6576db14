#pragma once

// The mathematics: docs/rig.md.

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// The offset and the parts of the rig that the options solve for: for a stationary rig, the rig is solved
/// for first, then the offset is estimated with it; for a walk, both in turn. Of a stationary rig whose motor
/// turns one way at one speed the rig alone (Estimate::offset_is_gauge). For the errors see `estimate`.
Result<Estimate> estimate_with_rig(const RecordingSource& source, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job);

/// Whether what was asked for was found: the offset, or where it is a gauge the mount or the encoder.
bool has_answer(const Estimate& found);

}  // namespace sweepscope
