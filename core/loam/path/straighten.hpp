#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <vector>

#include "core/loam/path/sweep_pose.hpp"

namespace sweepscope {

/// The path of a rig whose motor turns back at once, with its map straightened. A rig that stays about one
/// place sees each direction at one angle of the motor. If its first sweep is bent, so is the map: poses that
/// deviate by the same function of the motor's angle in every sweep match it as well as the true ones. Such a
/// deviation turns back with the motor, within an instant, which no body does: of the paths that differ by a
/// deviation linear in the motor's angle the one with the least acceleration is taken, of every stretch by
/// itself. What does not exceed twice its uncertainty stays. For sweeps that all have one direction nothing
/// changes.
std::vector<SweepPose> straightened(std::vector<SweepPose> sweeps);

}  // namespace sweepscope
