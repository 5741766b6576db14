#pragma once

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// The IMU and the odometry that the rig names, into the recording: in the order of time, in the base frame,
/// by the stamps that the laser goes by. A topic that the rig names and the file does not hold, and samples
/// that are of no use, are warned of.
void assemble_motion(const RawRecording& raw, Recording& recording);

}  // namespace sweepscope
