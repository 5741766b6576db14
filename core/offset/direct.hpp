#pragma once

// The mathematics: docs/algorithms.md, sections 8, 11 and 14.

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/offset_search.hpp"

namespace sweepscope {

/// The direct method: the offset as an unknown of a least squares, with its uncertainty. Of a stationary rig
/// see direct_stationary.hpp, of a moving one walk.hpp; a moving rig's trajectory goes by the poses of the
/// options or by the recording's own odometry or IMU, where there are any (for the errors see align_motion).
/// Unfinished where the job is cancelled.
Result<Answer> answer_directly(const OffsetSearch& search, const Job& job);

}  // namespace sweepscope
