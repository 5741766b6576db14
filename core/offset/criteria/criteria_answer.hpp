#pragma once

// The mathematics: docs/algorithms.md, sections 5.3 and 13.4.

#include <memory>
#include <vector>

#include "core/job.hpp"
#include "core/offset/criteria/stationary_candidate.hpp"
#include "core/offset/search/answer.hpp"
#include "core/offset/search/offset_search.hpp"
#include "core/offset/walk/walk.hpp"

namespace sweepscope {

/// What all candidates of a search have in common.
struct SharedByCandidates {
  OdometryOptions odometry;
  std::vector<std::size_t> pairs;  // of a stationary rig: the sweeps that the registered pairs begin with
  std::shared_ptr<const SolvedWalk> walk;  // of a moving one
};

/// The criterion whose least value gives the answer: d, or e of a rig that is treated as moving.
inline CurveValue decisive(const OffsetSearch& search) {
  return search.as_moving() ? &CurvePoint::e_m : &CurvePoint::d;
}

/// The criteria's extrema, what speaks against them, and the offset with its uncertainty: how far it lies
/// from that of the direct method, and how sure that one is.
Answer judged_by_criteria(const OffsetSearch& search, const SharedByCandidates& shared, Answer answer,
                          const Job& job);

}  // namespace sweepscope
