#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimate_plan.hpp"
#include "core/offset/prepared/recording_source.hpp"
#include "core/offset/search/offset_search.hpp"

namespace sweepscope {

/// The offset over time: windows, their course, and as the answer the offset at the middle of the recording.
/// The windows of a stationary rig are estimated one by one (follow_offset) from `planned`, which holds the
/// plan's parts. A walk is cut into stretches of at least half a minute, the trajectory of each is solved
/// separately, and its parts are the windows; a drifting offset is followed from stretch to stretch.
/// `begun` is what the estimate says so far. Incomplete if the job is cancelled.
Result<Estimate> follow_over_time(Estimate begun, const OffsetSearch& search, const RecordingSource& source,
                                  const Recording& planned, const EstimatePlan& plan, const Job& job);

}  // namespace sweepscope
