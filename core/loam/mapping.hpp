#pragma once

// The mathematics: docs/algorithms.md, sections 5.2 and 10.

#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/mapping_options.hpp"
#include "core/loam/path/sweep_pose.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/loam/sweep_matcher.hpp"

namespace sweepscope {

/// LOAM's result for a moving recording at one candidate offset.
struct TrackedWalk {
  std::vector<SweepPose> sweeps;    // of every sweep, in the order of time
  std::vector<std::size_t> starts;  // where it began, see MappingOptions, and others that were tried after it
  bool well = false;                // one stretch that does not alternate and that a second track confirms
  MatchCount count;                 // at LOAM's own converged pose of each sweep, before it enters the map

  /// Sweeps that are not lost.
  std::size_t tracked() const;
};

/// Tracks the sweeps on the map that they build (LOAM's odometry and mapping in one). It begins where the
/// matches determine the motion and the rig moved least, continues to the end, and then, on the same map,
/// goes back to the beginning. Then it begins elsewhere, until two tracks agree. Where the sweeps no longer
/// match the map, it starts a new map, called a stretch; stretches are joined by the velocity before the gap.
Result<TrackedWalk> track(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job);
/// The same for sweeps that are already placed.
Result<TrackedWalk> track(const std::vector<PlacedSweep>& sweeps, const MappingOptions& options,
                          const Job& job);

/// Times of the laser's clock.
struct Interval {
  double begin_s = 0, end_s = 0;  // on the clock of the laser
};
/// The intervals in which sweeps are lost, ascending.
std::vector<Interval> lost_intervals(const std::vector<SweepPose>& sweeps);

/// Rebuilds the map along given poses, ascending in time, and counts each sweep's matches with the map of the
/// sweeps before it that turned the other way (equations 4 to 7). Lost sweeps are left out. Unfinished if the
/// job is cancelled.
MatchCount count_matches(const OffsetProblem& problem, double offset_s, const std::vector<SweepPose>& poses,
                         const MappingOptions& options, const Job& job);

}  // namespace sweepscope
