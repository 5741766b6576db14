#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "core/loam/matching.hpp"

namespace sweepscope {

class GivenMotion;

/// How sweeps are tracked on the map and how matches are counted. Tuned on the walks of tuning/ in
/// tests/benchmark/walks.
struct MappingOptions {
  PatchOptions patch;                 // what counts as a plane or a line
  double search_radius_m = 0.5;       // for the neighbours of a feature
  double search_radius_slope = 0.12;  // of the range
  double loss_width_m = 0.08;         // Cauchy
  // Matches weigh by their range, in mean ranges of the sweep, between these bounds.
  double least_range_weight = 0.3, most_range_weight = 3;
  double match_sigma_m = 0.05;  // of a match, against the priors below: its neighbours err together

  double knot_s = 0.033;    // between two knots of the trajectory, about
  double tie_sigma = 0.01;  // rad and m: how far a sweep may correct the end of the one before
  // How much the velocity changes: this times what was seen over half sweeps, between these bounds.
  double acceleration_factor = 1.5;
  double min_acceleration = 0.5, max_acceleration = 8;  // rad/s^2 and m/s^2
  double first_acceleration = 1;                        // until enough sweeps are known
  double velocity_sigma = 2;                            // rad/s and m/s

  int max_iterations = 6;        // of the registration of one sweep
  int rough_iterations = 2;      // while only a part of the sweep is there ...
  int rough_stride = 2;          // ... with one feature in so many
  double step_tolerance = 5e-4;  // m and rad
  double reuse_within_m = 0.03;  // a match is searched again once its point moved by more

  double doubtful_below = 0.85;  // part of the usual share of matches: the sweep is tried in other ways
  double lost_below = 0.5;       // part of the usual share: the sweep does not enter the map
  int give_up_after = 4;         // lost sweeps in a row: a new map is begun
  int settling_sweeps = 8;       // not counted: the map is still being begun

  int first_sweeps = 4;         // from which the first pose is found ...
  int velocity_rounds = 6;      // ... by velocities that are tried in turn ...
  int first_pose_rounds = 3;    // ... and by matching them to each other, as long as less than this part ...
  double well_followed = 0.35;  // ... of their features matches
  // Sweeps to begin with, by their place among those that have scans. Empty: up to `max_starts` where the
  // matches of consecutive sweeps determine every direction of motion at least so well (of a feature; or
  // better than in half of the sweeps), until two tracks agree.
  std::vector<std::size_t> starts;
  double well_determined = 0.01;      // see `starts`
  int max_starts = 6;                 // places from which tracking is tried
  double max_alternation_rad = 0.07;  // beyond, sweeps of one direction lie beside those of the other

  // Instead of the above, for criteria that are counted at LOAM's own poses.
  double loam_knot_s = 0.25, loam_acceleration = 0.6, loam_tie_sigma = 0.005;

  /// A prior of the rig's motion, or, as the truth, the motion that is used instead of tracking.
  std::shared_ptr<const GivenMotion> given;

  double edge_gate_m = 0.1;   // delta_E of equation 4
  double plane_gate_m = 0.1;  // delta_H of equation 5
  double cost_cap_m = 0.3;    // what a feature without a match pays in the capped cost
};

}  // namespace sweepscope
