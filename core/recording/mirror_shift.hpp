#pragma once

// The mathematics: docs/algorithms.md, section 1.

#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// The least time by which the motion of a motor that turns to and fro can be shifted so that it is its own
/// mirror image, or itself again: scans of a stationary rig then show a mirrored or turned world that fits as
/// well. A sweep of an even motor. A motor that starts, stops, pauses or changes its speed in the first 40
/// sweeps, those that the coarse search uses, has such a shift later, at most after half of them. A multiple
/// of MotorMotion::median_sweep_s.
double mirror_shift_s(const MotorTrack& track, const MotorMotion& motion);

}  // namespace sweepscope
