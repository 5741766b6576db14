#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <optional>
#include <vector>

#include "core/offset/estimate.hpp"
#include "core/recording/recording_parts.hpp"

namespace sweepscope {

/// Which parts of a long recording an estimate of a stationary rig goes by: ten groups of six sweeps, spread
/// evenly from the first sweep to the last, hold as much as it needs to know, and show whether the offset
/// changes. Seconds since the first scan, with a margin to either side of each group.
struct SampledSweeps {
  std::vector<RecordingPart> groups;
  SweepSample counts;
};

/// Absent for recordings of less than a minute, and where the groups would be more than half of the sweeps.
std::optional<SampledSweeps> sampled_sweeps(const Recording& recording);

}  // namespace sweepscope
