#include "core/loam/sweep_features.hpp"

namespace sweepscope {
namespace {

void place(const FeatureList& list, std::size_t scan, const Sweep& sweep, double offset_s,
           const Kinematics& kinematics, MotorReader& motor, std::vector<PlacedFeature>& placed) {
  for (std::size_t i = list.scan_begin[scan]; i < list.scan_begin[scan + 1]; ++i) {
    const Feature& feature = list.features[i];
    const double motor_s = feature.time_s + offset_s;
    if (motor_s < sweep.steady_begin_s || motor_s > sweep.steady_end_s) continue;
    placed.push_back(
        {kinematics.base_from_motor(feature.p_in_motor_m.cast<double>(), motor.angle_at(motor_s)),
         (motor_s - sweep.begin_s) / (sweep.end_s - sweep.begin_s), feature.range_m, feature.scan,
         feature.sharp});
  }
}

}  // namespace

std::vector<PlacedSweep> place_sweeps(const OffsetProblem& problem, double offset_s) {
  const auto& scans = problem.recording->scans;
  const Kinematics kinematics(problem.recording->rig.mount);
  MotorReader motor(problem.recording->motor);
  const std::vector<std::size_t> sweep_of = assign_sweeps(scans, problem.motor.sweeps, offset_s);
  std::vector<PlacedSweep> placed;
  for (std::size_t scan = 0; scan < scans.size(); ++scan) {
    if (sweep_of[scan] == kNoSweep || !problem.scan_used[scan]) continue;
    const Sweep& sweep = problem.motor.sweeps[sweep_of[scan]];
    if (placed.empty() || placed.back().sweep != sweep_of[scan]) {
      PlacedSweep& next = placed.emplace_back();
      next.sweep = sweep_of[scan];
      next.direction = sweep.direction;
      next.begin_s = sweep.begin_s - offset_s;
      next.end_s = sweep.end_s - offset_s;
    }
    ++placed.back().scans;
    place(problem.features->edges, scan, sweep, offset_s, kinematics, motor, placed.back().edges);
    place(problem.features->planes, scan, sweep, offset_s, kinematics, motor, placed.back().planes);
  }
  return placed;
}

}  // namespace sweepscope
