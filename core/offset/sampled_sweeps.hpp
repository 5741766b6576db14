#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <optional>
#include <vector>

#include "core/offset/estimate.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// The parts of a long recording that an estimate of a stationary rig uses: ten groups of six sweeps, spread
/// evenly from the first sweep to the last. They suffice for a constant offset and show whether it changes.
/// Seconds since the first scan, with a margin on either side of each group.
struct SampledSweeps {
  std::vector<RecordingPart> groups;
  SweepSample counts;
};

/// Absent for recordings shorter than a minute, and if the groups would hold more than half of the sweeps.
std::optional<SampledSweeps> sampled_sweeps(const Recording& recording);

}  // namespace sweepscope
