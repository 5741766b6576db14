#pragma once

// The mathematics: docs/algorithms.md, section 19.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"

namespace sweepscope {

/// Surfaces that were seen twice and lie at different places in the map.
struct SurfacesApart {
  double first_s = 0, again_s = 0;                    // seconds since the recording's first scan
  double apart_m = 0;                                 // by which what was seen again has to move to coincide
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  // of what was seen again, map frame
};

/// A part of the walk in which something is wrong.
struct DoubtfulTime {
  Interval at_s;                                      // seconds since the recording's first scan
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  // of the rig, map frame
};

/// A part of the walk in which the surfaces do not determine the motion.
struct UndeterminedTime : DoubtfulTime {
  double speed_mps = 0, speed_beside_mps = 0;  // of the trajectory there, and before and after
  double missing_m = 0;                        // of the way, if the speed beside holds
};

/// A part of the walk in which nothing in view shows how far the rig moved along a direction.
struct DriftingTime : DoubtfulTime {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // unit, map frame, as the rig moved
  // Standard deviations by what is known of how speeds change: of the way along it, and of the root of the
  // mean square error that this causes in the whole trajectory.
  double drift_m = 0, rmse_m = 0;
};

/// Whether the surfaces that a moving rig saw more than once coincide in its map.
struct MapConsistency {
  double limit_m = 0;                // farther apart, the map is warned of
  std::vector<SurfacesApart> apart;  // those whose distance is determined, the farthest apart first
  std::vector<DoubtfulTime> unfit;   // most of what these sweeps saw lies beside the surfaces about it
  std::vector<UndeterminedTime> undetermined;
  std::vector<DriftingTime> drifting;
  std::optional<std::string> drift_warning;  // about a trajectory that was found from the surfaces alone
  std::vector<std::string> warnings;         // empty: the map is right as far as that is determined

  /// Absent if no surface was seen twice: the consistency is then not determined.
  std::optional<SurfacesApart> worst() const;
  bool warned() const { return !warnings.empty(); }
  /// By what was seen, how far the map is from agreeing with itself: beyond 1 it is warned of.
  double doubt = 0;
  bool agrees_with_itself() const { return doubt <= 1; }
};

/// Compares what a rig saw in each two seconds with what it saw at other times. Both directions of turning
/// count alike, so that a wrong offset, which turns them against each other, moves nothing. `poses` are those
/// of the problem's sweeps, all of which a SweepPlacer at `offset_s` places; lost ones are left out. The same
/// result for any number of threads. Absent if the job is cancelled.
std::optional<MapConsistency> map_consistency(const OffsetProblem& problem,
                                              const std::vector<SweepPose>& poses, double offset_s,
                                              const Job& job);

/// "surfaces seen twice lie at most 0.021 m apart"
std::string in_words(const MapConsistency& consistency);

}  // namespace sweepscope
