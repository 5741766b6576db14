#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <optional>
#include <span>
#include <vector>

#include "core/loam/mapping_options.hpp"
#include "core/loam/sweep_matcher.hpp"

namespace sweepscope {

/// Sweeps that were tracked on one map of their own, in its frame (stretch_from_base), ascending in time.
struct Stretch {
  std::vector<PlacedSweep> sweeps;
  std::vector<SweepPose> poses;
};

/// Finds where a rig that was lost is on the map of what it saw before.
class Relocaliser {
 public:
  /// The options must outlive it.
  explicit Relocaliser(const MappingOptions& options) : options_(options) {}

  /// Adds a sweep at its pose in the map.
  void insert(const PlacedSweep& sweep, const SweepPose& pose);

  /// map_from_stretch: the rig may have walked and turned about the map's z axis for `gap_s` since it was at
  /// `last` (map_from_base), and is tilted by about as much as then. Absent where too few of the features
  /// match the map anywhere, or where they match it in several places.
  std::optional<Pose> find(Stretch stretch, const Pose& last, double gap_s) const;

 private:
  struct Found {
    Pose map_from_stretch;
    double matched_part = 0;
  };
  std::vector<Pose> likely_poses(std::span<const Eigen::Vector3d> points_m, const Pose& last,
                                 double gap_s) const;
  Found refined(const Stretch& stretch, Pose map_from_stretch) const;

  const MappingOptions& options_;
  SweepMaps maps_;
  std::vector<Eigen::Vector3f> points_m_;  // of the planes in the map
};

}  // namespace sweepscope
