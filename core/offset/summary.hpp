#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/inspect.hpp"
#include "core/recording/recording.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// The expected accuracy of an estimate from a recording, or why it will be refused, by the estimator's own
/// limits: whole sentences. `motor` are the sweeps of its motor track.
std::vector<std::string> expectations(const Recording& recording, const RecordingSummary& summary,
                                      const MotorMotion& motor);

/// `inspect`, with the motion test's answer and the expectations. Fails only where the job is cancelled
/// (ExitCode::kInterrupted).
Result<RecordingSummary> summarise(const Recording& recording, const Job& job);

}  // namespace sweepscope
