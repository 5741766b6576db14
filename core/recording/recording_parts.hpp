#pragma once

#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// A part of a recording, in seconds since its first scan.
struct RecordingPart {
  double begin_s = 0, end_s = 0;
};

/// The scans that begin in a part, and the motor's samples from `motor_margin_s` before to as much after
/// them, without intensities: a copy as large as the part, found by bisection.
Recording part_of(const Recording& recording, const RecordingPart& part, double motor_margin_s);

/// The scans of several parts, and the recording's first and last scan, so that it lasts as long; without
/// intensities. The motor's samples are all kept.
Recording parts_of(const Recording& recording, const std::vector<RecordingPart>& parts);

}  // namespace sweepscope
