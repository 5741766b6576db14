#pragma once

// The mathematics: docs/rig.md, "Several recordings".

#include <vector>

#include "core/offset/estimator.hpp"

namespace sweepscope {

/// One answer from several recordings of one rig: the weighted mean of their offsets, or with `own_offsets`
/// an offset for each; and with EstimateOptions::solve the rig from one least squares over all of them, with
/// which every offset is found. Estimate::together holds what each recording contributes. Recordings that do
/// not agree on one rig are refused (RefusalKind::kRecordingsDiffer), and the one that differs is named.
///
/// The direct method only. Errors: those of `estimate`; ExitCode::kWrongUsage for fewer than two recordings,
/// an offset over time, poses, another method, or rig files that differ.
Result<Estimate> estimate_together(const std::vector<RecordingSource>& recordings,
                                   const EstimateOptions& options, bool own_offsets, const Job& job);

}  // namespace sweepscope
