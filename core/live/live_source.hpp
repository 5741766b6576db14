#pragma once

#include <chrono>

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Where a running rig's scans and motor samples come from. Used by one thread.
class LiveSource {
 public:
  virtual ~LiveSource() = default;
  /// Takes what has come, waiting for it at most so long; false at the end of the input.
  virtual Result<bool> listen(std::chrono::milliseconds most) = 0;
  /// All that was heard until now, as it is.
  virtual const RawRecording& so_far() const = 0;
  /// The same with warnings about what was skipped.
  virtual RawRecording heard() = 0;
};

}  // namespace sweepscope
