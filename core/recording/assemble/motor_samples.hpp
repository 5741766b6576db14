#pragma once

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A spacing of the motor's samples beyond this many median ones is a gap.
inline constexpr double kMotorGapFactor = 3.0;

/// Says that what a number means is not said in the file.
void warn_of_source(const RawJoint& joint, Recording& recording);

/// Turns a joint's samples into the recording's motor track. False where fewer than two samples are usable.
bool assemble_motor(const RawJoint& raw, Recording& recording);

}  // namespace sweepscope
