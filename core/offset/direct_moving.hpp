#pragma once

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/joint_walk.hpp"

namespace sweepscope {

/// The offset of a walking rig. Tracked with a pose of its own at every reversal, each sweep is turned about
/// the motor's axis by omega (offset - truth), against its neighbours: the roll from one sweep to the next is
///   roll(offset) = slope (offset - truth),  slope near 2 omega,
/// so a few passes over the walk come near its zero. There walk and offset are solved for together (see
/// joint_walk.hpp), and e must rise to both sides of the answer.
struct MovingDirectOptions {
  MappingOptions mapping;
  int most_passes = 6;
  double step_tolerance_s = 1e-3;  // near enough for the joint solution
  double most_step_s = 0.006;
  double side_s = 0.003;  // where e is asked on both sides
  JointWalkOptions joint;
};

/// One pass over the walk.
struct MovingPass {
  double offset_s = 0;
  bool tracked = false;
  double roll_rad = 0;
  std::vector<double> sweep_s, sweep_roll_rad;  // per sweep: the middle's time, and its own share of the roll
  std::vector<SweepPose> sweeps;                // the alternating roll taken out
};

/// The standard deviation of a pass's roll, from blocks of its sweeps.
std::optional<double> sigma_of_roll(const std::vector<double>& sweep_roll_rad);

/// The rotation (rad) by which a body that sways in step with the motor turns from one sweep to the next.
/// Told from what an offset cannot do, which turns whole sweeps about the motor's axis: by the middles' turns
/// about the axes across it, and by the turns within the sweeps.
double alternating_sway_rad(const std::vector<SweepPose>& sweeps, const Eigen::Vector3d& motor_axis);

MovingPass moving_pass(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                       const Job& job);

struct MovingDirect {
  bool converged = false;
  bool lost = false;
  double roll_offset_s = 0;  // where the last pass asks the roll to be zero
  std::vector<MovingPass> passes;
  std::optional<JointWalk> joint;
  double sway_rad = 0;            // in step with the motor, see alternating_sway_rad
  std::vector<CurvePoint> curve;  // n, e and capped cost along the joint walk: below, at and above the answer
};

/// The problem cut down to its first sweeps.
OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t most_sweeps);

MovingDirect solve_moving(const OffsetProblem& problem, double first_offset_s,
                          const MovingDirectOptions& options, const Job& job);

}  // namespace sweepscope
