#include "core/offset/criteria/moving_candidate.hpp"

#include <limits>

namespace sweepscope {
namespace {

CurvePoint point_of(double offset_s, const MatchCount& count) {
  CurvePoint point;
  point.offset_s = offset_s;
  if (count.matches == 0) return point;
  point.capped_cost_m = count.capped_cost_m();
  point.n = static_cast<double>(count.matches);
  point.e_m = count.mean_distance_m();
  return point;
}

}  // namespace

CurvePoint moving_candidate(const OffsetProblem& problem, double offset_s,
                            const std::vector<SweepPose>& trajectory, const MappingOptions& options,
                            const Job& job) {
  const MatchCount count = count_matches(problem, offset_s, trajectory, options, job);
  CurvePoint point = point_of(offset_s, count);
  if (count.matches > 0) point.signed_rotation_rad = count.roll_rad();
  return point;
}

CurvePoint loam_candidate(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job) {
  MappingOptions stiff = options;
  stiff.knot_s = options.loam_knot_s;
  stiff.min_acceleration = stiff.max_acceleration = options.loam_acceleration;
  stiff.tie_sigma = options.loam_tie_sigma;
  const auto walk = track(problem, offset_s, stiff, job);
  if (!walk || 2 * walk->tracked() < walk->sweeps.size()) return point_of(offset_s, {});
  return point_of(offset_s, walk->count);
}

}  // namespace sweepscope
