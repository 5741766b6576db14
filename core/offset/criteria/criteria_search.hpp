#pragma once

// The mathematics: docs/algorithms.md, section 5.2.

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/offset/search/answer.hpp"
#include "core/offset/search/offset_search.hpp"

namespace sweepscope {

/// The paper's methods: d (section 3.2), or n and e (section 3.3), at candidate offsets, and their extrema.
/// Of the given candidates, or coarse to fine about the best of the coarse search. Unfinished where the job
/// is cancelled; the curve then holds the candidates that were computed. Fails where the store does.
Result<Answer> answer_by_criteria(const OffsetSearch& search, const KeptCandidates& kept, const Job& job);

}  // namespace sweepscope
