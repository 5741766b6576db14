#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <vector>

#include "core/loam/mapping_options.hpp"
#include "core/loam/sweep_matcher.hpp"

namespace sweepscope {

/// Follows a rig sweep by sweep on the map that it builds. A sweep's trajectory is solved for while its scan
/// lines arrive, a knot at a time (constant velocity first), then as a whole: the sum over its matches of the
/// squared distances from the map's planes and lines, the changes of velocity and, weakly, the velocities.
/// Where few features match, the sweep is tried with other motions, and the one that matches best is taken.
/// With MappingOptions::given, in sweeps that it covers, motion and velocity mean the deviation from it.
class Tracker {
 public:
  /// `time_sign` is -1 for sweeps whose time runs backwards.
  Tracker(const MappingOptions& options, double time_sign = 1);

  /// The next sweep, whose pose is known, goes into the map; so must the first one, for which there is none
  /// yet.
  void know(const PlacedSweep& sweep, const SweepPose& pose);
  /// The pose of the next sweep; those that are not lost go into the map.
  SweepPose add(const PlacedSweep& sweep);

  /// From now on the sweeps before `first`, the latest one first, each as `reversed` gives it.
  void turn_back(const SweepPose& first);

  int lost_in_a_row() const { return lost_in_a_row_; }
  /// Of the latest sweep, at its own pose, before it entered the map.
  const MatchCount& last_count() const { return last_count_; }
  /// Whether the map held several sweeps before the latest one.
  bool settled() const { return sweeps_ > options_.settling_sweeps; }

 private:
  // One way to begin the search for a sweep's motion.
  struct Attempt {
    double acceleration_factor;  // how far the motion may change, against what is usual
    double carried;              // part of the velocity that is kept
  };
  struct Solved {
    std::vector<Pose> path;
    MatchCount count;
  };

  void begin_path(const PlacedSweep& sweep, std::size_t steps);
  bool begin_along_given(const PlacedSweep& sweep, std::size_t steps);
  Pose given_move(double from_s, double to_s) const;
  Solved solved(const PlacedSweep& sweep, std::size_t steps) const;
  Solved attempt(const PlacedSweep& sweep, std::size_t steps, const SearchRule& rule,
                 const Attempt& attempt) const;
  double improve(std::vector<Pose>& path, PathEquations& equations, double acceleration_factor,
                 const Eigen::Vector3d& pivot_m) const;
  std::vector<Pose> extrapolated(std::vector<Pose> path, double carried) const;
  void judge(const MatchCount& count);
  void learn_acceleration(const SweepPose& pose);
  bool grown() const { return sweeps_ >= options_.settling_sweeps; }

  const MappingOptions& options_;
  double time_sign_;
  std::vector<Pose> path_;   // the present sweep's knots
  Pose before_;              // a step before them
  std::vector<Pose> moves_;  // the given motion's to each knot from the one before it; empty without one
  double step_s_ = 0, end_s_ = 0;
  Eigen::Vector2d acceleration2_;  // mean square of a component: of the rotation, of the translation
  Vector6d last_twist_per_s_ = Vector6d::Zero();  // of the last sweep's second half
  int learned_ = 0;
  double usual_part_ = 0.5;  // of the features that find a match; at first that of a walk tracked well
  int sweeps_ = 0, lost_in_a_row_ = 0;
  bool after_gap_ = false;  // until a sweep matches again
  MatchCount last_count_;
  SweepMaps maps_;
};

/// The sweep, or its pose, as if time ran backwards from 0.
PlacedSweep reversed(PlacedSweep sweep);
SweepPose reversed(SweepPose pose);

/// The pose of the first of these sweeps. There is no map to match it to, so its velocity is guessed,
/// tried and averaged (without averaging the estimate would oscillate); then it is matched to the map of the
/// others, and the others to its map, in turn.
SweepPose find_first_pose(const std::vector<PlacedSweep>& sweeps, const MappingOptions& options);

}  // namespace sweepscope
