#pragma once

#include <optional>

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Makes a recording of what a file holds: chooses the laser, the motor's joint and the stamps, puts both
/// streams into the order of time on one epoch (the whole second at or before the first scan's stamp),
/// resolves when each first beam was fired, marks unusable ranges NaN, and counts and reports all that was
/// not as it should be.
///
/// Scans: stamp_at last_beam and arrival both take the stamp as the last beam's instant. A scan cannot arrive
/// earlier than that; how much later it does is unknown, and becomes part of the offset. Motor: an angle that
/// jumps by more than 3/4 of a turn between two neighbouring samples has wrapped, and is unwrapped. The IMU
/// and the odometry that the rig names go by the kind of stamps that the laser goes by.
Result<Recording> assemble(RawRecording raw, const Rig& rig, std::optional<StampSource> stamps);

/// The IMU and the odometry that the rig names, into the recording: in the order of time, in the base frame,
/// by the stamps that the laser goes by. A topic that the rig names and the file does not hold, and samples
/// that are of no use, are warned of.
void assemble_motion(const RawRecording& raw, Recording& recording);

}  // namespace sweepscope
