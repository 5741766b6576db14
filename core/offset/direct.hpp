#pragma once

#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/motion_source.hpp"
#include "core/offset/rig_motion.hpp"
#include "core/offset/search_window.hpp"
#include "core/offset/still_points.hpp"

namespace sweepscope {

/// The least of the coarse cost over a window of candidates, by unit steps, each candidate computed once. The
/// cost compares the ranges of neighbouring sweeps at equal motor angle and beam, as if nothing had moved: on
/// a walk the motion blurs the valley, but leaves it where it is. On the first `most_sweeps` of the
/// recording.
struct CoarseSearch {
  std::vector<CurvePoint> curve;  // ascending; capped_cost_m
  std::optional<std::size_t> best;
  double offset_s() const { return curve[*best].offset_s; }
};
CoarseSearch search_coarsely(const OffsetProblem& problem, const std::vector<double>& window_s,
                             const SearchScale& scale, const Job& job);

/// The direct method: writes answer, evidence, warnings and reasons into `result`, which knows its recording,
/// sweeps and scans already. `motion` is what the motion test found, however the rig is treated. A moving
/// rig's trajectory goes by `source`, where there is one; for its errors see align_motion.
Result<void> estimate_directly(const OffsetProblem& problem, const CoarseSearch& coarse, bool moving,
                               const MotionTest& motion, const MappingOptions& mapping,
                               const std::optional<MotionSource>& source, const Job& job, Estimate& result);

}  // namespace sweepscope
