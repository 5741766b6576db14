#include "core/offset/criteria/stationary_candidate.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

bool form_pair(const PlacedSweep& first, const PlacedSweep& second, const MotorMotion& motor) {
  const double min_s = 0.25 * motor.median_sweep_s;
  return second.sweep == first.sweep + 1 && first.end_s - first.begin_s > min_s &&
         second.end_s - second.begin_s > min_s;
}

}  // namespace

std::vector<PairMotion> pair_motions(const OffsetProblem& problem, double offset_s,
                                     const OdometryOptions& options) {
  const std::vector<PlacedSweep> sweeps = place_sweeps(problem, offset_s);
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  std::vector<PairMotion> motions;
  for (std::size_t k = 1; k < sweeps.size(); ++k) {
    if (!form_pair(sweeps[k - 1], sweeps[k], problem.motor)) continue;
    const Registration found = register_rigidly(map_of(sweeps[k - 1]), sweeps[k], options);
    const Eigen::Vector3d rotation_rad = vector_from_rotation(found.target_from_source.rotation);
    // A sweep turned too far by omega error must be turned back by as much, and its neighbour the other way.
    motions.push_back({sweeps[k - 1].sweep, found.succeeded, found.target_from_source.translation_m.norm(),
                       rotation_rad.norm(), -sweeps[k].direction * axis.dot(rotation_rad)});
  }
  return motions;
}

CurvePoint stationary_candidate(const OffsetProblem& problem, double offset_s,
                                const std::vector<std::size_t>& pairs, double weight_c,
                                const OdometryOptions& options) {
  CurvePoint point;
  point.offset_s = offset_s;
  double d = 0, translation_m = 0, rotation_rad = 0, signed_rotation_rad = 0;
  std::size_t count = 0;
  for (const PairMotion& motion : pair_motions(problem, offset_s, options)) {
    if (std::find(pairs.begin(), pairs.end(), motion.sweep) == pairs.end()) continue;
    if (!motion.succeeded) return point;
    ++count;
    d += std::sqrt(motion.translation_m * motion.translation_m +
                   weight_c * motion.rotation_rad * motion.rotation_rad);
    translation_m += motion.translation_m;
    rotation_rad += motion.rotation_rad;
    signed_rotation_rad += motion.signed_rotation_rad;
  }
  if (count == 0 || count != pairs.size()) return point;
  const double n = static_cast<double>(count);
  point.d = d / n;
  point.translation_m = translation_m / n;
  point.rotation_rad = rotation_rad / n;
  point.signed_rotation_rad = signed_rotation_rad / n;
  return point;
}

}  // namespace sweepscope
