#pragma once

#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/feature_map.hpp"
#include "core/loam/matching.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/loam/sweep_motion.hpp"

namespace sweepscope {

/// How sweeps are tracked on the map and how matches are counted.
struct MappingOptions {
  PatchOptions patch;
  double search_radius_m = 0.5;
  double search_radius_slope = 0.12;  // of the range
  double loss_width_m = 0.08;         // Cauchy
  double match_sigma_m = 0.05;        // of a match, against the ties below: its neighbours err together
  double tie_sigma = 0.03;            // rad and m: a sweep's begin to the previous sweep's end ...
  double first_tie_sigma = 0.3;       // ... and at first, when the jump at a reversal is not known yet
  bool expects_jump = true;  // learn the jump; else a sweep begins where the last one ended, as in LOAM ...
  double continuous_tie_sigma = 0.005;  // ... rad and m, to within this
  double jump_gain = 0.05;              // of a new jump in the mean of all
  double bend_sigma = 0.02;             // rad and m: how far a sweep's motion bends
  double twist_change_sigma = 0.08;     // rad and m per sweep: how freely the motion changes
  int most_iterations = 6;
  int rough_iterations = 2;      // of these, while the points still move by more than their matches hold: ...
  int rough_stride = 4;          // ... with one feature in so many
  double step_tolerance = 5e-4;  // m and rad
  double reuse_within_m = 0.03;  // a match is searched anew once its point moved by more
  int settling_sweeps = 8;       // not counted: the map is still being begun
  int velocity_rounds = 6;       // to find the first velocity
  int velocity_sweeps = 4;
  double edge_gate_m = 0.1;   // delta_E of equation 4
  double plane_gate_m = 0.1;  // delta_H of equation 5
  double cost_cap_m = 0.3;    // what a feature without a match pays in the capped cost
};

/// A sweep's poses at its begin and end; between them the pose is interpolated. map_from_base.
struct SweepPose {
  std::size_t sweep = 0;  // index into MotorMotion::sweeps
  int direction = 0;
  double begin_s = 0, end_s = 0;  // laser clock
  Pose begin, end;
  Vector6d bend = Vector6d::Zero();  // between them, see SweepMotion
  std::size_t features = 0, matches = 0;

  SweepMotion motion() const { return SweepMotion(begin, end, bend); }
  Eigen::Vector3d pivot_m() const { return (begin.translation_m + end.translation_m) / 2; }
  Pose at(double u) const { return stepped(interpolate(begin, end, u), bend_at(u) * bend, pivot_m()); }
  Pose middle() const { return at(0.5); }
};

/// The counts behind equations 6 and 7, and a cost over all sharp features in which a miss pays the cap.
struct MatchCount {
  std::size_t features = 0, matches = 0;
  double distance_sum_m = 0;
  double capped_sum_m = 0;

  double mean_distance_m() const { return matches == 0 ? 0.0 : distance_sum_m / double(matches); }
  double capped_cost_m() const { return features == 0 ? 0.0 : capped_sum_m / double(features); }
  MatchCount& operator+=(const MatchCount& other) {
    features += other.features;
    matches += other.matches;
    distance_sum_m += other.distance_sum_m;
    capped_sum_m += other.capped_sum_m;
    return *this;
  }
};

/// What LOAM makes of a moving recording at one candidate offset.
struct TrackedWalk {
  std::vector<SweepPose> sweeps;
  MatchCount count;   // at LOAM's own converged pose of each sweep, before it enters the map
  bool lost = false;  // most features of a stretch found no match
};

/// Tracks the sweeps on the map that they build (LOAM's odometry and mapping in one): each sweep has a pose
/// at its begin and one at its end, tied softly to the previous sweep's end, since a wrong offset makes the
/// sweeps seem to roll to and fro and strict continuity would lose track of it.
Result<TrackedWalk> track(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                          const Job& job);
/// The same of sweeps that are placed already.
Result<TrackedWalk> track(const std::vector<PlacedSweep>& sweeps, const Eigen::Vector3d& motor_axis,
                          const MappingOptions& options, const Job& job);

/// The roll about the motor's axis that alternates from sweep to sweep, and the walk without it.
struct AlternatingRoll {
  double signed_rotation_rad = 0;               // from one sweep to the next; near 2 omega (offset - truth)
  std::vector<SweepPose> sweeps;                // with the alternation taken out
  std::vector<double> sweep_s, sweep_roll_rad;  // each judged sweep's middle (laser clock) and share: their
                                                // mean, without the outermost tenths, is the roll
};

/// Measures the roll by which the pose jumps to and fro at the reversals, the end of one sweep against the
/// begin of the next, through the filter [-1 2 -1] / 4 that passes nothing of a quadratic roll, and turns it
/// back. Jumps and not the sweeps' middles: a walker sways at much the motor's own frequency, but does not
/// jump.
AlternatingRoll take_out_alternating_roll(const std::vector<SweepPose>& sweeps,
                                          const Eigen::Vector3d& motor_axis, int settling_sweeps);

/// Rebuilds the map along given poses, ascending in time, and counts each sweep's matches with the map of the
/// sweeps before it that turned the other way (equations 4 to 7).
MatchCount count_matches(const OffsetProblem& problem, double offset_s, const std::vector<SweepPose>& poses,
                         const MappingOptions& options);
/// The same of sweeps that are placed already, with a pose for each.
MatchCount count_matches(const std::vector<PlacedSweep>& sweeps, const std::vector<SweepPose>& poses,
                         const MappingOptions& options);

}  // namespace sweepscope
