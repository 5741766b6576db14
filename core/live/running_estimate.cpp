#include "core/live/running_estimate.hpp"

#include <chrono>
#include <utility>

namespace sweepscope {

void RunningEstimate::begin(RawRecording heard, const CalibrationOptions& options) {
  about_ = heard_so_far(heard);
  answer_ = std::async(std::launch::async, [this, &options, raw = std::move(heard)]() mutable {
    return calibrate(std::move(raw), options, job_);
  });
}

std::optional<Result<Estimate>> RunningEstimate::take() {
  if (idle() || answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  return answer_.get();
}

}  // namespace sweepscope
