#pragma once

#include "core/loam/mapping.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimator.hpp"

namespace sweepscope {

/// The paper's criteria of section 3.3 at a candidate offset: n (equation 6) and e (equation 7), and the
/// signed alternating roll. With Scoring::kTwoStage they are counted after the roll is taken out of the
/// trajectory; with kLoam at LOAM's own converged poses. All absent where track was lost.
CurvePoint moving_candidate(const OffsetProblem& problem, double offset_s, Scoring scoring,
                            const MappingOptions& options, const Job& job);

}  // namespace sweepscope
