#pragma once

#include <filesystem>
#include <vector>

#include "core/job.hpp"
#include "core/offset/estimator.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/rig_solve/rig_solve.hpp"
#include "render/report/report.hpp"

namespace sweepscope {

struct ReportOptions {
  std::optional<RigKind> assume = std::nullopt;  // instead of the motion test
  RigSolve solve = {};                           // of the rig, beside the offset
  std::size_t live_points = kDefaultLivePoints;  // of the live map; 0: no live map
};

/// The content of a report on a recording: the offset, as `estimate` finds it with default options; the
/// paper's criteria for that kind of rig as evidence; and the maps at the answer and 5 ms off, all along one
/// trajectory, with a live map of at most `options.live_points`. Where the rig is solved for, criteria and
/// maps are those of the rig found. Long work; an interruption is ExitCode::kInterrupted. Finished candidates
/// are kept in the store, if any.
Result<ReportContent> gather_report(const PreparedRecording& prepared, const ReportOptions& options,
                                    CandidateStore* kept, const Job& job);

/// Creates the folder of a report if it does not exist.
Result<void> make_report_folder(const std::filesystem::path& folder);

/// The files that `write_report` writes.
std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder);

/// Writes report.html and estimate.json into a folder, which is created if it does not exist. An
/// interruption is ExitCode::kInterrupted, and leaves no file.
Result<void> write_report(const ReportContent& content, const std::filesystem::path& folder,
                          const Job& job = {});

}  // namespace sweepscope
