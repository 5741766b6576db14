#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/map/offset_map.hpp"
#include "core/offset/walk/walk.hpp"

namespace sweepscope {

/// What the beams of a map are placed along: poses from elsewhere (MapOptions::poses), a solved trajectory,
/// or none where the rig is stationary.
struct MapPath {
  bool moving = false;
  std::shared_ptr<const SolvedWalk> walk;  // of a moving rig without poses from elsewhere
  std::string warning;  // of poses that do not cover every scan, or of a map in pieces; else empty
};

/// The path of a recording whose offset lies between `from_s` and `to_s`. For the errors see build_maps.
Result<MapPath> find_map_path(const OffsetProblem& problem, double from_s, double to_s,
                              const MapOptions& options, const Job& job);

/// The sweeps of a stationary rig, with identity poses.
std::vector<SweepPose> stationary_poses(const OffsetProblem& problem, double offset_s);

}  // namespace sweepscope
