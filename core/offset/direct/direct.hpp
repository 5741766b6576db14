#pragma once

// The mathematics: docs/algorithms.md, sections 8, 11 and 14.

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/search/answer.hpp"
#include "core/offset/search/offset_search.hpp"

namespace sweepscope {

/// The direct method: the offset as an unknown of a least squares, with its uncertainty. For a stationary rig
/// see direct_stationary.hpp, for a moving one walk.hpp; a moving rig's trajectory uses the poses of the
/// options or the recording's own odometry or IMU, if there are any (for the errors see align_motion).
/// Unfinished if the job is cancelled.
Result<Answer> answer_directly(const OffsetSearch& search, const Job& job);

}  // namespace sweepscope
