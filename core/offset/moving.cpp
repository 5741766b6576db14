#include "core/offset/moving.hpp"

namespace sweepscope {

CurvePoint moving_candidate(const OffsetProblem& problem, double offset_s, Scoring scoring,
                            const MappingOptions& options, const Job& job) {
  CurvePoint point;
  point.offset_s = offset_s;
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  MappingOptions tracking = options;
  // Poses that may jump at the reversals take the wrong offset up, and the map looks sharp at any: LOAM's own
  // do not.
  tracking.expects_jump = scoring != Scoring::kLoam;
  const auto walk = track(problem, offset_s, tracking, job);
  if (!walk || walk->lost) return point;
  const AlternatingRoll roll = take_out_alternating_roll(walk->sweeps, axis, options.settling_sweeps);
  const MatchCount count =
      scoring == Scoring::kLoam ? walk->count : count_matches(problem, offset_s, roll.sweeps, options);
  point.signed_rotation_rad = roll.signed_rotation_rad;
  if (count.features > 0) point.capped_cost_m = count.capped_cost_m();
  point.n = static_cast<double>(count.matches);
  if (count.matches > 0) point.e_m = count.mean_distance_m();
  return point;
}

}  // namespace sweepscope
