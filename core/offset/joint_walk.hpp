#pragma once

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/uncertainty.hpp"

namespace sweepscope {

/// The offset of a walk and the walk itself as the unknowns of one least squares. Every point is held against
/// surfaces that sweeps of the other direction saw, and both sides move: the walk, which is continuous,
/// linear between knots and accelerates little, and the motor's angle under both. A wrong offset turns the
/// two directions against each other all along a sweep, whatever the walk does; a body that sways in step
/// with the motor does so at most between the reversals, where the walk cannot jump. The walk is cut into
/// parts that are solved each by itself, with a map of its own: cost and memory grow with the length alone,
/// and the parts tell how far to trust their mean.
struct JointWalkOptions {
  MappingOptions mapping;           // how the maps are searched
  double part_s = 20;               // about how long a part is
  double knot_s = 0.09;             // between knots of the walk
  double acceleration_sigma = 0.6;  // rad/s^2 and m/s^2 of a walking body, alike
  double match_sigma_m = 0.03;      // of a match: neighbours err together
  double loss_width_m = 0.05;       // Cauchy
  double offset_sigma_s = 0.01;     // of the offset that it starts from
  int most_iterations = 6;
  double step_tolerance = 0.25;     // of the part's sigma: matches come and go with every step
  std::size_t least_matches = 200;  // of a part
};

struct JointWalkPart {
  double middle_s = 0;  // laser clock
  double offset_s = 0, sigma_s = 0;
  double step_s = 0;  // the last one
  std::size_t features = 0, matches = 0;
  double lever_m2 = 0, reach_m2 = 0;  // sums over the matches of (n . (a x p))^2 and of |a x p|^2
  bool converged = false;
};

struct JointWalk {
  double step_s = 0;    // what the last steps of parts that did not converge move the mean by, at most
  double offset_s = 0;  // weighted mean of the parts
  double sigma_s = 0;   // from the parts' own, widened where they scatter more
  std::vector<JointWalkPart> parts;  // those with enough matches
  std::vector<SweepPose> sweeps;     // along the smooth walk; those of parts left out as they were given
  std::size_t features = 0, matches = 0;
  double lever_m = 0, reach_m = 0;  // root mean squares over all matches
  bool converged = false;           // every part did
};

/// `tracked` are the poses of the problem's sweeps as `track` gives them at `offset_s`, their alternating
/// roll taken out. Absent where no part has enough matches, or the job was cancelled. The same bytes for any
/// number of threads.
std::optional<JointWalk> solve_joint_walk(const OffsetProblem& problem, const std::vector<SweepPose>& tracked,
                                          double offset_s, const JointWalkOptions& options, const Job& job);

/// How the offset changes over the walk, from its parts.
std::optional<Trend> drift_of(const JointWalk& walk);

}  // namespace sweepscope
