#pragma once

#include "core/job.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/recording.hpp"
#include "render/report/report.hpp"

namespace sweepscope {

/// All that a report tells of a recording: its offset by the method that the motion test names (or `assume`),
/// what the direct method says, and the maps at the answer and 5 ms off. Long work; an interruption is
/// ExitCode::kInterrupted.
Result<ReportContent> gather_report(const Recording& recording, std::optional<Method> assume, const Job& job);

/// Writes report.html and estimate.json into a folder, which is made where it is not there.
Result<void> write_report(const ReportContent& content, const std::filesystem::path& folder);

}  // namespace sweepscope
