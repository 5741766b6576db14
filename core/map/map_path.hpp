#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/map/consistency/map_consistency.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/walk/walk.hpp"

namespace sweepscope {

/// What a recording's beams are placed along, whatever the offset: the scans that are used, the motor's
/// sweeps, and where the base frame was: on poses from elsewhere, on a solved trajectory, or, of a stationary
/// rig, in the map frame.
struct MapPath {
  bool moving = false;
  std::vector<char> used;          // per scan; those of 0 are not placed
  std::vector<Sweep> sweeps;       // of the motor, on its clock
  std::vector<StampedPose> poses;  // from elsewhere; empty: the trajectory is solved for, or there is none
  std::shared_ptr<const SolvedWalk> walk;             // of a moving rig without poses from elsewhere
  std::shared_ptr<const MapConsistency> consistency;  // of a moving rig whose track was not lost; else null
  // Of poses that do not cover every scan, a map in pieces, one that does not agree with itself, or a motion
  // that nothing shows; else empty.
  std::string warning;

  bool lost() const { return walk && walk->lost; }
};

/// The path of a recording whose offset lies between `from_s` and `to_s`. For the errors see build_maps.
Result<MapPath> find_map_path(const PreparedRecording& prepared, double from_s, double to_s,
                              const MapOptions& options, const Job& job);

/// The path of a stationary rig, or along poses from elsewhere, of the scans that are `used`. A motor that
/// does not turn has no sweeps: all scans then belong to one.
MapPath path_without_solving(const PreparedRecording& prepared, std::vector<char> used,
                             std::vector<StampedPose> poses = {});

}  // namespace sweepscope
