#pragma once

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// What is known of a laser or a joint apart from its messages.
RawLaser without_scans(const RawLaser& laser);
RawJoint without_samples(const RawJoint& joint);

/// Takes the scans, samples and warnings out of a recording that grows. Its topics, lasers, joints and frames
/// stay known with their numbers, and the result lists them, too.
RawRecording take_messages(RawRecording& growing);

}  // namespace sweepscope
