#pragma once

// The mathematics: docs/algorithms.md, sections 11 and 13.2.

#include <limits>
#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/walk/time_shift.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {

/// The offset of a walk and the walk itself as the unknowns of one least-squares problem. Every point is
/// matched to surfaces that sweeps of the other direction measured, and both sides move: the walk, a cubic
/// B-spline whose acceleration changes little, and the motor's angle under both. A wrong offset turns the two
/// directions against each other along the whole sweep, independent of the walk; a body that sways in step
/// with the motor does so only between the reversals, where the walk cannot jump. The walk is cut into parts
/// that are solved separately, each with its own map: cost and memory are proportional to the length, and the
/// scatter of the parts gives the uncertainty of their mean. Tuned on the walks of tuning/ in
/// tests/benchmark/walks.
struct JointWalkOptions {
  MappingOptions mapping;  // how the maps are searched
  double part_s = 10;      // about how long a part is
  double knot_s = 0.06;    // between knots of the walk
  // How freely the acceleration changes: this times what is seen over half sweeps. A wrong offset of a motor
  // that turns back at once shows in jumps, which no body can imitate: the walk may be as free as that.
  double jerk_factor = 10;
  // That of a motor that slows down before shows in a roll as smooth as a body's sway: this times what is
  // seen over whole sweeps, which tracking errs less in.
  double jerk_factor_of_smooth_motors = 10;
  double min_jerk = 0.6;  // rad/s^3 and m/s^3
  double match_sigma_m = 0.012;
  double loss_width_m = 0.03;    // Cauchy
  double offset_sigma_s = 0.01;  // of the offset that it starts from
  // Every iteration matches again, and other matches give another answer: the mean of several is more
  // accurate. Without averaged ones the answer counts as not converged.
  int first_iterations = 3, averaged_iterations = 6;
  // If the first iterations lead further away, the others are not run: the walk must be tracked again.
  double far_s = std::numeric_limits<double>::infinity();
  // Of `adjusted`: with one feature in so many, then with all. Tuned on tests/benchmark/worlds.
  int rough_iterations = 10, whole_iterations = 2;
  std::size_t rough_stride = 5;
  double longest_s = 300;
  std::size_t min_matches = 200;  // of a part; in a furnished place it has some thousands
};

struct JointWalkPart {
  double middle_s = 0;  // laser clock
  double offset_s = 0, sigma_s = 0;
  double step_s = 0;  // between the means of the first and the last averaged iterations
  std::size_t features = 0, matches = 0;
  double lever_m2 = 0, reach_m2 = 0;  // sums over the matches of (n . (a x p))^2 and of |a x p|^2
  bool converged = false;
  std::optional<TimeShift> time_shift;  // where the part followed a given motion
};

struct JointWalk {
  double step_s = 0;    // what the last steps of parts that did not converge move the mean by, at most
  double offset_s = 0;  // weighted mean of the parts
  double sigma_s = 0;   // from the parts' own, widened where they scatter more, and the two below
  double unseen_sigma_s =
      0;                    // of it: what bends of the path within the sweeps may hide, see unseen_of_part_s
  double sway_sigma_s = 0;  // of it: what a sway in step with a motor that turns back smoothly may hide
  std::vector<JointWalkPart> parts;  // those with enough matches
  std::vector<SweepPose> sweeps;     // along the smooth walk; those of parts left out as they were given
  std::size_t features = 0, matches = 0;
  double lever_m = 0, reach_m = 0;      // root mean squares over all matches
  bool converged = false;               // every part did
  std::optional<TimeShift> time_shift;  // of the parts that followed a given motion, as the offset
};

/// `tracked` are the poses of the problem's sweeps as `track` gives them at `offset_s`. Absent where no part
/// has enough matches, or the job was cancelled; not converged where it leads away by more than `far_s`. The
/// same bytes for any number of threads.
std::optional<JointWalk> solve_joint_walk(const OffsetProblem& problem, const std::vector<SweepPose>& tracked,
                                          double offset_s, const JointWalkOptions& options, const Job& job);

/// A walk that was adjusted as a whole, and how its features then fit each other.
struct AdjustedWalk {
  std::vector<SweepPose> sweeps;
  MatchCount count;
};

/// The walk again, each stretch in one piece of up to `longest_s`: every point is matched to the surfaces
/// that sweeps of the other direction measured at any time, seen from the same side. A tracked sweep was
/// matched to what was seen before it alone, and errors remain where they were made; here they are spread.
/// Pieces of longer stretches begin and end where they were tracked. Stretches of few sweeps stay as they
/// are. The same bytes for any number of threads.
AdjustedWalk adjusted(const OffsetProblem& problem, std::vector<SweepPose> tracked, double offset_s,
                      const JointWalkOptions& options, const Job& job);

/// How the offset changes over the walk, from its parts. Its sigma allows for how few they are.
std::optional<Trend> drift_of(const JointWalk& walk);

}  // namespace sweepscope
