#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <memory>
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

/// What of a recording an estimate goes by. Reading and estimating obey it.
struct EstimatePlan {
  /// The sweeps that the search and the motion test go by, and the answer of a stationary rig; none: all. A
  /// rig that moved needs all of the recording.
  std::optional<SampledSweeps> sample;
  /// The windows of an offset over time; empty: one offset is asked for. Seconds since the first scan.
  std::vector<RecordingPart> windows;

  /// What is read first: the sample and the used parts of the windows; empty: all of the recording.
  std::vector<RecordingPart> parts;

  bool over_time() const { return !windows.empty(); }
  /// The sweeps of the plan, from a recording that holds its parts.
  std::shared_ptr<const Recording> sweeps_of(std::shared_ptr<const Recording> recording) const;
};

/// The plan for these options, from a recording's outline (no ranges are looked at). The paper's methods go
/// by all of it; `keeps_candidates` makes an estimate one of theirs, see method_of.
EstimatePlan plan_estimate(const Recording& outline, const EstimateOptions& options, bool keeps_candidates);

}  // namespace sweepscope
