#pragma once

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/inspect.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// `inspect`, with the motion test's answer and what an estimate can be expected to reach. Fails only where
/// the job is cancelled (ExitCode::kInterrupted).
Result<RecordingSummary> summarise(const Recording& recording, const Job& job);

}  // namespace sweepscope
