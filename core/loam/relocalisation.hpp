#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <functional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping_options.hpp"
#include "core/loam/path/sweep_pose.hpp"
#include "core/loam/sweep_features.hpp"

namespace sweepscope {

/// The sweeps of a tracked walk, moved so that each stretch lies where it fits the map of the stretches
/// before it: the rig may have walked and turned about the map's z axis while it was lost, and is tilted by
/// about as much as before. Sweeps between that were not tracked go evenly from where the rig was to where it
/// is. What was moved belongs to the first stretch then. A stretch that fits nowhere, or in several places,
/// keeps its number, and its place behind the one before it. `place` gives the features of a sweep, by its
/// index. Unchanged where there is one stretch.
std::vector<SweepPose> relocalised(std::vector<SweepPose> sweeps,
                                   const std::function<PlacedSweep(std::size_t)>& place,
                                   const MappingOptions& options, const Job& job);

}  // namespace sweepscope
