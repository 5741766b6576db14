#pragma once

#include <limits>
#include <span>

#include "core/recording/recording.hpp"
#include "render/pictures/scanner_mark.hpp"

namespace sweepscope {

/// The scanner at the end of a path (poses of the base frame, ascending in time), or at its last pose that is
/// not after `until_s` (laser clock), with the motor's angle at t_motor = t_laser + offset. Without a path
/// the rig is stationary at the map frame's origin.
ScannerPose scanner_pose(const Recording& recording, std::span<const StampedPose> path, double offset_s,
                         double until_s = std::numeric_limits<double>::infinity());

}  // namespace sweepscope
