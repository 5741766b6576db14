#pragma once

#include <optional>

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Makes a recording from the content of a file: chooses the laser, the motor's joint and the stamps, sorts
/// both streams by time on one epoch (the whole second at or before the first scan's stamp), finds when each
/// first beam was fired, sets unusable ranges to NaN, and counts and reports every irregularity.
///
/// Scans: stamp_at last_beam and arrival both take the stamp as the last beam's instant. A scan cannot arrive
/// earlier than that; how much later it does is unknown, and becomes part of the offset. Motor: an angle that
/// jumps by more than 3/4 of a turn between two neighbouring samples has wrapped, and is unwrapped. The IMU
/// and the odometry that the rig names use the same kind of stamps as the laser.
Result<Recording> assemble(RawRecording raw, const Rig& rig, std::optional<StampSource> stamps);

/// Adds the IMU and the odometry that the rig names to the recording: in order of time, in the base frame, by
/// the kind of stamps that the laser uses. Warns of a named topic that the file does not hold, and of
/// unusable samples.
void assemble_motion(const RawRecording& raw, Recording& recording);

}  // namespace sweepscope
