#pragma once

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Which of RawRecording::lasers is the scanner: the one that the rig names, or the only one of scans, else
/// of scans with several echoes, else of clouds. Otherwise an error that lists the choices.
Result<std::size_t> choose_laser(const RawRecording& raw, const Rig& rig);

/// Which of RawRecording::joints is the motor: the one that the rig names, the only one that moves (by more
/// than 1 deg), or the only one. If the rig names no topic, only joints of the best JointSource are
/// considered. Otherwise an error that lists the choices: a robot's wheels move too, and the motion of a
/// joint does not show what it carries.
Result<std::size_t> choose_joint(const RawRecording& raw, const Rig& rig);

/// Warns of several frame_ids on the laser's topic: the scans may be of several scanners.
void warn_of_frames(const RawLaser& laser, Recording& recording);

}  // namespace sweepscope
