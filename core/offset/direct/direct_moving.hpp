#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <memory>
#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/prepared/curve_point.hpp"
#include "core/offset/walk/walk.hpp"

namespace sweepscope {

/// The offset of a moving rig: solved for together with its trajectory (see walk.hpp). e must rise to both
/// sides of the answer.
struct MovingDirectOptions {
  WalkOptions walk;
  double side_s = 0.003;  // from the answer to where e is computed on both sides: figure 6 of the paper
                          // clearly changes by then
};

struct MovingDirect {
  std::shared_ptr<const SolvedWalk> walk;
  bool converged = false;
  double sway_rad = 0;            // in step with the motor, see alternating_sway_rad
  std::vector<CurvePoint> curve;  // n, e and capped cost along the walk: below, at and above the answer
};

/// Absent if the job was cancelled.
std::optional<MovingDirect> solve_moving(const OffsetProblem& problem, double first_offset_s,
                                         const MovingDirectOptions& options, const Job& job);

}  // namespace sweepscope
