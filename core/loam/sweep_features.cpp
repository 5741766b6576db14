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

SweepPlacer::SweepPlacer(const OffsetProblem& problem, double offset_s)
    : problem_(problem),
      offset_s_(offset_s),
      kinematics_(problem.recording->rig.mount),
      motor_(problem.recording->motor),
      sweep_of_(assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s)) {}

bool SweepPlacer::next(PlacedSweep& placed) {
  placed.edges.clear();
  placed.planes.clear();
  placed.scans = 0;
  for (; scan_ < sweep_of_.size(); ++scan_) {
    if (sweep_of_[scan_] == kNoSweep || !problem_.scan_used[scan_]) continue;
    const Sweep& sweep = problem_.motor.sweeps[sweep_of_[scan_]];
    if (placed.scans > 0 && placed.sweep != sweep_of_[scan_]) return true;
    placed.sweep = sweep_of_[scan_];
    placed.direction = sweep.direction;
    placed.begin_s = sweep.begin_s - offset_s_;
    placed.end_s = sweep.end_s - offset_s_;
    ++placed.scans;
    place(problem_.features->edges, scan_, sweep, offset_s_, kinematics_, motor_, placed.edges);
    place(problem_.features->planes, scan_, sweep, offset_s_, kinematics_, motor_, placed.planes);
  }
  return placed.scans > 0;
}

std::vector<PlacedSweep> place_sweeps(const OffsetProblem& problem, double offset_s) {
  SweepPlacer placer(problem, offset_s);
  std::vector<PlacedSweep> all;
  for (PlacedSweep sweep; placer.next(sweep); sweep = {}) all.push_back(std::move(sweep));
  return all;
}

}  // namespace sweepscope
