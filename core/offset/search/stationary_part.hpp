#pragma once

// The mathematics: docs/algorithms.md, section 9.

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/prepared/prepared.hpp"

namespace sweepscope {

/// When the rig was stationary, and when it moved.
struct MotionCourse {
  std::vector<MotionPart> parts;  // see motion_over_time; with the part below in its place
  /// The longest part in which the rig was stationary, if it is long enough for an estimate: at least 3 s and
  /// one and a half sweeps. Whole tenths of a second since the first scan, within what the scan lines show.
  std::optional<RecordingPart> stationary;
};

/// Of a recording in which the rig moved; of one that is stationary all the time `stationary` is absent.
/// Sweeps of the same direction show a stationary part to within a pair of sweeps; of few, long sweeps
/// neighbouring ones are tried, at the offset that fits them best. The scan lines then show where it begins
/// and ends (motion_of_lines).
MotionCourse motion_course(const PreparedRecording& prepared, const Job& job);

}  // namespace sweepscope
