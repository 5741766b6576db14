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
      one_way_(problem.motor.one_way()),
      sweep_of_(assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s)) {
  std::size_t last = kNoSweep;
  for (std::size_t scan = 0; scan < sweep_of_.size(); ++scan) {
    if (!problem.scan_used[scan]) sweep_of_[scan] = kNoSweep;
    if (sweep_of_[scan] == kNoSweep) continue;
    if (sweep_of_[scan] != last) scans_.push_back({scan, scan});
    scans_.back().end = scan + 1;
    last = sweep_of_[scan];
  }
}

void SweepPlacer::place(std::size_t i, PlacedSweep& placed) {
  const auto [first, end] = scans_[i];
  const Sweep& sweep = problem_.motor.sweeps[sweep_of_[first]];
  placed.sweep = sweep_of_[first];
  placed.direction = sweep.direction;
  placed.side = !one_way_ ? sweep.direction : placed.sweep % 2 == 0 ? 1 : -1;
  placed.begin_s = sweep.begin_s - offset_s_;
  placed.end_s = sweep.end_s - offset_s_;
  placed.turned_rad = sweep.direction * sweep.speed_rad_s * (sweep.end_s - sweep.begin_s) *
                      problem_.recording->rig.mount.axis.normalized();
  placed.scans = 0;
  placed.edges.clear();
  placed.planes.clear();
  for (std::size_t scan = first; scan < end; ++scan) {
    if (sweep_of_[scan] == kNoSweep) continue;
    ++placed.scans;
    sweepscope::place(problem_.features->edges, scan, sweep, offset_s_, kinematics_, motor_, placed.edges);
    sweepscope::place(problem_.features->planes, scan, sweep, offset_s_, kinematics_, motor_, placed.planes);
  }
}

bool SweepPlacer::next(PlacedSweep& placed) {
  if (next_ == scans_.size()) return false;
  place(next_++, placed);
  return true;
}

std::vector<PlacedSweep> place_sweeps(const OffsetProblem& problem, double offset_s) {
  SweepPlacer placer(problem, offset_s);
  std::vector<PlacedSweep> all;
  for (PlacedSweep sweep; placer.next(sweep); sweep = {}) all.push_back(std::move(sweep));
  return all;
}

void thin(PlacedSweep& sweep, std::size_t stride) {
  for (std::vector<PlacedFeature>* features : {&sweep.edges, &sweep.planes}) {
    std::size_t i = 0;
    for (PlacedFeature& feature : *features)
      if (feature.sharp) feature.sharp = i++ % stride == 0;
  }
}

}  // namespace sweepscope
