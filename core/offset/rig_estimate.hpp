#pragma once

// The mathematics: docs/rig.md.

#include <optional>
#include <string>

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// The part of a recording from which a stationary rig is solved for.
struct RigPart {
  PreparedRecording prepared;
  double offset_s = 0;  // near the true one; 0 where it is a gauge
  std::string note;     // which part of a walk it is: a sentence after a blank, empty for a whole recording

  OffsetProblem problem() const { return problem_for(prepared, offset_s, offset_s); }
};

/// A whole stationary recording, or the longest part of a walk in which the rig was stationary. `found`: the
/// estimate of the offset alone. None where there is no such part or no offset, not even that of a rig file
/// too wrong for an estimate.
std::optional<RigPart> part_for_rig(const PreparedRecording& prepared, const Estimate& found,
                                    const EstimateOptions& options, const Job& job);

/// The estimate of a recording whose offset is a gauge, with the kind of rig, which is decided at any offset.
Estimate with_kind_of_gauge(const PreparedRecording& prepared, const EstimateOptions& options,
                            Estimate found);

/// The offset and the parts of the rig that the options solve for: for a stationary rig, the rig is solved
/// for first, then the offset is estimated with it; for a walk, both in turn. Of a stationary rig whose motor
/// turns one way at one speed the rig alone (Estimate::offset_is_gauge). For the errors see `estimate`.
Result<Estimate> estimate_with_rig(const RecordingSource& source, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job);

/// Whether what was asked for was found: the offset, or where it is a gauge the mount or the encoder.
bool has_answer(const Estimate& found);

}  // namespace sweepscope
