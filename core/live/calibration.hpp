#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/live/live_source.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Finding the offset of a running rig that stands still, before data acquisition (section 3.2 of the paper).
struct CalibrationOptions {
  double seconds = 10;    // of scans, by their own stamps
  double silence_s = 10;  // after so long without a scan stamped later than those before listening ends
  double every_s = 2;     // of scans, between running answers
  Rig rig;
  std::optional<StampSource> stamps;
  EstimateOptions estimate;
};

/// How much was heard: of the laser with the most scans, and of all joints.
struct HeardSoFar {
  double seconds = 0;  // from its first scan's stamp to its last one's
  std::size_t scans = 0, motor_samples = 0;
};
HeardSoFar heard_so_far(const RawRecording& raw);

/// What is kept at most of what is heard, whatever comes: far more than scanners and motors send in the
/// seconds asked for.
struct HeardLimits {
  std::size_t scan_bytes = 0, motor_samples = 0;
  std::size_t names = 0;  // of topics, joints and frames
};
HeardLimits limits_of(const CalibrationOptions& options);

/// Why listening ended.
enum class ListeningEnd {
  kHeardEnough,
  kInputEnded,
  kSilence,           // nothing came any more
  kNoScans,           // motor samples came, and no scans
  kStampsStandStill,  // scans came that were not stamped later than those before
  kTooMuch,           // the limits were reached
  kCancelled,
};

/// Listens until enough was heard, one of the other ends came, or the job was cancelled, and reports how far
/// it is. `tell` gets the answer to what was heard meanwhile, worked out beside the listening; its calls
/// come from this thread. Fails where the source does.
Result<ListeningEnd> listen(
    LiveSource& source, const CalibrationOptions& options, const Job& job,
    const std::function<void(const HeardSoFar& heard, const Result<Estimate>& answer)>& tell);

/// The offset from what was heard. A rig that moved is refused, and so is too little, with the reason in the
/// estimate; streams that are not plain to choose fail as for a recording.
Result<Estimate> calibrate(RawRecording heard, const CalibrationOptions& options, const Job& job);

}  // namespace sweepscope
