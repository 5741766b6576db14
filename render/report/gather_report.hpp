#pragma once

#include <filesystem>
#include <vector>

#include "core/job.hpp"
#include "core/offset/estimator.hpp"
#include "core/offset/kept_candidates.hpp"
#include "core/recording/recording.hpp"
#include "render/report/report.hpp"

namespace sweepscope {

/// All that a report tells of a recording: its offset by the method that the motion test names (or `assume`),
/// what the direct method says, and the maps at the answer and 5 ms off. Long work; an interruption is
/// ExitCode::kInterrupted. Finished candidates are kept in the store, where there is one.
Result<ReportContent> gather_report(const Recording& recording, std::optional<Method> assume,
                                    CandidateStore* kept, const Job& job);

/// Makes the folder that a report goes to, where it is not there.
Result<void> make_report_folder(const std::filesystem::path& folder);

/// The files that `write_report` writes.
std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder);

/// Writes report.html and estimate.json into a folder, which is made where it is not there.
Result<void> write_report(const ReportContent& content, const std::filesystem::path& folder);

}  // namespace sweepscope
