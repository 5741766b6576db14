#pragma once

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/estimate.hpp"

namespace sweepscope {

/// The offset of a walking rig by Newton on the signed alternating roll. Tracked with a pose of its own at
/// every reversal, each sweep is turned about the motor's axis by omega (offset - truth), against its
/// neighbours: the roll from one sweep to the next is
///   roll(offset) = slope (offset - truth),  slope near 2 omega,
/// so a few passes over the walk find its zero. e must rise to both sides of it; the parabola through e
/// there, below and above, gives the answer its last hundredths of a millisecond: e draws on every match, the
/// roll on the reversals.
struct MovingDirectOptions {
  MappingOptions mapping;
  int most_passes = 6;
  double step_tolerance_s = 1e-4;  // a smaller step needs no further pass: the roll is linear
  double most_step_s = 0.006;
  double side_s = 0.003;  // where e is asked on both sides
};

/// One pass over the walk.
struct MovingPass {
  double offset_s = 0;
  bool tracked = false;
  double roll_rad = 0;
  std::vector<double> sweep_s, sweep_roll_rad;  // per sweep: the middle's time, and its own share of the roll
};
/// The standard deviation of a pass's roll, from blocks of its sweeps.
std::optional<double> sigma_of_roll(const std::vector<double>& sweep_roll_rad);

MovingPass moving_pass(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                       const Job& job);

struct MovingDirect {
  bool converged = false;
  bool lost = false;
  double roll_offset_s = 0;  // where the roll is zero
  double offset_s = 0;       // the answer
  std::optional<double> sigma_s;
  double slope_of_nominal = 0;  // of the roll, divided by 2 omega; near 1 where the run can be trusted
  std::vector<MovingPass> passes;
  std::vector<CurvePoint> curve;  // n and e at five offsets about the roll's zero, which is the third
  // Blocks of neighbouring sweeps, which err together: middle and the offset that each asks for by itself.
  std::vector<double> block_s, block_offset_s;
};

/// The problem cut down to its first sweeps.
OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t most_sweeps);

MovingDirect solve_moving(const OffsetProblem& problem, double first_offset_s,
                          const MovingDirectOptions& options, const Job& job);

}  // namespace sweepscope
