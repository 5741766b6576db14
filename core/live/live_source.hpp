#pragma once

#include <chrono>

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// The source of a running rig's scans and motor samples. Used by one thread.
class LiveSource {
 public:
  virtual ~LiveSource() = default;
  /// Takes the data that arrived, waiting at most this long; false at the end of the input.
  virtual Result<bool> listen(std::chrono::milliseconds max_wait) = 0;
  /// Everything received so far, unmodified.
  virtual const RawRecording& so_far() const = 0;
  /// The same with warnings about what was skipped.
  virtual RawRecording heard() = 0;
  /// Takes out the scans and samples received since the last call: see take_messages().
  virtual RawRecording take() = 0;
};

}  // namespace sweepscope
