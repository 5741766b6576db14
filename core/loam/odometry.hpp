#pragma once

// The mathematics: docs/algorithms.md, section 5.1.

#include "core/loam/feature_map.hpp"
#include "core/loam/matching.hpp"
#include "core/loam/sweep_features.hpp"

namespace sweepscope {

/// How two sweeps are registered. The search radius grows with range, since scan lines spread. By judgement:
/// halved or doubled, each changes the offsets of least d in two simulated rooms by at most 0.13 ms, but for
/// half the plane neighbours, which give no answer (sweepscope_option_changes of tests/benchmark).
struct OdometryOptions {
  /// What counts as a plane or a line.
  PatchOptions patch{.plane_neighbours = 9,
                     .edge_neighbours = 6,
                     .per_line = 3,
                     .min_lines = 3,
                     .thickness_m = 0.02,
                     .thickness_slope = 0.01};
  double search_radius_m = 0.5;       // for the neighbours of a feature
  double search_radius_slope = 0.25;  // of the range, or more where scan lines lie far apart: see for_lines
  double loss_width_m = 0.1;          // Cauchy
  int max_iterations = 20;            // of one registration
  double step_tolerance = 2e-5;       // m and rad: under a hundredth of the paper's least d, 0.0037
  int min_matches = 100;              // fewer are no registration
  double min_eigenvalue =
      0.003;  // of the normal matrix, per match: below it, the scene does not determine the direction
};

/// The options with a search radius that reaches three scan lines `line_spacing_rad` apart, as a plane needs.
OdometryOptions for_lines(OdometryOptions options, double line_spacing_rad);

/// The result of registering one sweep to another.
struct Registration {
  Pose target_from_source;                // the motion found
  bool succeeded = false;                 // it had enough matches
  int iterations = 0;                     // until it converged, or the maximum
  std::size_t features = 0, matches = 0;  // of the source; those with a match at the last step
  int free_directions = 0;     // that the scene does not determine; their part of the pose is left at 0
  double mean_distance_m = 0;  // of the matches, at the end
};

/// A sweep's edge and plane points as maps to register against.
struct SweepMap {
  SweepMap() : edges(0.6, false), planes(0.6, false) {}
  FeatureMap edges, planes;  // the features of a sweep, to be searched
};
/// The features of a sweep as a map that others are registered to.
SweepMap map_of(const PlacedSweep& sweep);

/// Registers a sweep to another rigidly, without motion inside either (LOAM's odometry for a stationary rig,
/// undamped and iterated to convergence). p_in_target = target_from_source * p_in_source, both base frames.
Registration register_rigidly(const SweepMap& target, const PlacedSweep& source,
                              const OdometryOptions& options);

}  // namespace sweepscope
