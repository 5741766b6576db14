#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/live/live_source.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// Options for finding the offset of a running, stationary rig, before data acquisition (section 3.2 of the
/// paper).
struct CalibrationOptions {
  double seconds = 10;  // of scans, by their own stamps
  double silence_s =
      10;              // listening ends after this time without a scan that is stamped later than all before
  double every_s = 2;  // of scans, between running answers
  Rig rig;
  std::optional<StampSource> stamps;
  EstimateOptions estimate;
  std::function<std::chrono::steady_clock::time_point()> now =
      std::chrono::steady_clock::now;  // what silence is measured by
};

/// How much was received: from the laser with the most scans, and from all joints.
struct HeardSoFar {
  double seconds = 0;  // from its first scan's stamp to its last one's
  std::size_t scans = 0, motor_samples = 0;
};
HeardSoFar heard_so_far(const RawRecording& raw);

/// A sentence that says which scans or angles were not received: those that the rig names, if it names any.
std::string none_received(const std::string& what, const std::optional<std::string>& topic,
                          const std::optional<std::string>& joint = {});

/// The limits of what is kept: far more than scanners and motors send in the requested time.
struct HeardLimits {
  std::size_t scan_bytes = 0, motor_samples = 0;
  std::size_t names = 0;  // of topics, joints and frames
};
HeardLimits limits_of(const CalibrationOptions& options);

/// Why listening ended.
enum class ListeningEnd {
  kHeardEnough,
  kInputEnded,
  kSilence,           // no data arrived any more
  kNoScans,           // motor samples arrived, but no scans
  kStampsStandStill,  // scans arrived that were not stamped later than those before
  kTooMuch,           // the limits were reached
  kCancelled,
};

/// Listens until enough data arrived, listening ended for another reason, or the job was cancelled, and
/// reports progress. `tell` receives running answers, which are computed while listening; it is called on
/// this thread. Fails if the source fails.
Result<ListeningEnd> listen(
    LiveSource& source, const CalibrationOptions& options, const Job& job,
    const std::function<void(const HeardSoFar& heard, const Result<Estimate>& answer)>& tell);

/// The offset from the received data. If the rig moved, or there is too little data, the estimate is a
/// refusal with the reason; an ambiguous choice of streams fails as for a recording.
Result<Estimate> calibrate(RawRecording heard, const CalibrationOptions& options, const Job& job);

}  // namespace sweepscope
