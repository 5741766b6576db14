#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <span>
#include <vector>

#include "core/loam/path/sweep_pose.hpp"

namespace sweepscope {

/// For each sweep whether two tracks of the same sweeps, each on a map of its own, found the same motion:
/// over at least 2 s that the sweep is within, to within some centimetres and degrees. Tracks that began at
/// different places err in different places.
std::vector<char> agreeing(std::span<const SweepPose> a, std::span<const SweepPose> b);

}  // namespace sweepscope
