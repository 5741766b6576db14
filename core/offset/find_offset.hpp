#pragma once

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimate_plan.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/offset/prepared/recording_source.hpp"

namespace sweepscope {

/// The main path, from a recording to its offset: coarse search, motion test, method, answer. For the errors
/// see `estimate`. Unfinished where the job is cancelled.
Result<Estimate> find_offset(const RecordingSource& source, const EstimatePlan& plan,
                             const EstimateOptions& options, const KeptCandidates& kept, const Job& job);

}  // namespace sweepscope
