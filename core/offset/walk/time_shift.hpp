#pragma once

// The mathematics: docs/algorithms.md, section 12.

#include <optional>
#include <vector>

#include "core/loam/path/given_motion.hpp"
#include "core/loam/path/sweep_pose.hpp"

namespace sweepscope {

/// A given motion's time shift (see GivenMotion::time_shift_s).
struct TimeShift {
  double time_s = 0, sigma_s = 0;
};

/// The time shift at which a given motion turns like tracked sweeps: turns within 0.1 s, in the base frame,
/// are correlated about each axis over all overlaps of the two, and the best shift is refined by least
/// squares on their differences.
struct TurnCorrelation {
  TimeShift shift;
  double likelihood = 0;  // the logarithm of how much likelier the turns are than without a relation
  double lead = 0;     // by which that is more than at any other shift, near shifts being likelier a priori
  bool clear = false;  // the shift stands out
};

/// Absent where fewer than 3 s of sweeps were tracked, or where the overlaps are shorter than that.
std::optional<TurnCorrelation> correlate_turns(const std::vector<SweepPose>& sweeps,
                                               const GivenMotion& given);

/// The weighted mean of several estimates, its sigma widened where they scatter more than theirs say.
TimeShift mean_of(const std::vector<TimeShift>& shifts);

}  // namespace sweepscope
