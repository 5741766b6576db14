#pragma once

// The mathematics: docs/algorithms.md, section 5.2.

#include <span>

#include "core/loam/mapping.hpp"
#include "core/offset/prepared/curve_point.hpp"

namespace sweepscope {

/// The paper's criteria of section 3.3 at a candidate offset: n (equation 6), e (equation 7) and the capped
/// cost of the map that is built along a given trajectory, and the signed alternating roll: how far the
/// sweeps of one direction are turned against those of the other, near 2 omega (offset - truth). All absent
/// where nothing matches. Unfinished if the job is cancelled.
CurvePoint moving_candidate(const OffsetProblem& problem, double offset_s,
                            const std::vector<SweepPose>& trajectory, const MappingOptions& options,
                            const Job& job);

/// n and e as the paper counts them, at LOAM's own converged pose of each sweep before it enters the map. The
/// motion within a sweep is as stiff as LOAM's: one that could bend would take up a wrong offset.
CurvePoint loam_candidate(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job);

}  // namespace sweepscope
