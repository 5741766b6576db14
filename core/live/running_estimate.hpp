#pragma once

#include <future>
#include <optional>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/live/calibration.hpp"
#include "core/offset/estimate.hpp"

namespace sweepscope {

/// An answer that is worked out beside the listening, about what was heard when it was begun.
class RunningEstimate {
 public:
  RunningEstimate() = default;
  RunningEstimate(const RunningEstimate&) = delete;
  RunningEstimate& operator=(const RunningEstimate&) = delete;
  ~RunningEstimate() { job_.cancel(); }  // the future's destructor waits

  bool idle() const { return !answer_.valid(); }
  /// See calibrate(). The options must outlive the answer.
  void begin(RawRecording heard, const CalibrationOptions& options);
  /// Nothing if none was begun, or it is not finished.
  std::optional<Result<Estimate>> take();
  /// Waits for the one that was begun.
  Result<Estimate> wait() { return answer_.get(); }
  const HeardSoFar& about() const { return about_; }

 private:
  Job job_;
  HeardSoFar about_;
  std::future<Result<Estimate>> answer_;
};

}  // namespace sweepscope
