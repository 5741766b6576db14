#pragma once

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A spacing of the motor's samples beyond this many median ones is a gap.
inline constexpr double kMotorGapFactor = 3.0;

/// Says that what a number means is not said in the file.
void warn_of_source(const RawJoint& joint, Recording& recording);

/// Turns a joint's samples into the recording's motor track. False where fewer than two samples are usable.
bool assemble_motor(const RawJoint& raw, Recording& recording);

/// The same from a signal that marks each turn (Rig::Motor::index): the angle grows by a turn from one to the
/// next, and between them evenly but for changes of speed. False with fewer than two.
bool assemble_index(const RawJoint& raw, Recording& recording);

/// The angles of the rig's profile (Rig::Motor::profile) on the laser's clock, for the time of the scans and
/// half a period, at most 60 s, before and after.
void assemble_profile(Recording& recording);
/// The samples alone, in the place of those that are there.
void turn_by_profile(Recording& recording);

}  // namespace sweepscope
