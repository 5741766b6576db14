#pragma once

// docs/algorithms.md, section 14, lists them; a test holds both to each other.

#include <cstddef>

#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// Beyond which limits a recording does not determine its offset. A unit is SearchScale::unit_s. "Shown by
/// thresholds": tests/benchmark/thresholds prints how far good recordings stay from the limit.
struct Limits {
  // The streams.
  std::size_t min_motor_samples = 3;
  double max_swing_deg = 1500;    // of a motor that turns back, or of one with steps of most of a turn
  double min_speed_change = 0.1;  // of a one-way motor's speed; less is its own or the encoder's unevenness
  double max_scan_time_spread = 0.25;  // of a period, nine times in ten
  double min_samples_per_sweep = 3;    // the law of encoder_sampling_sigma_s is known down to it
  double max_scans_in_gaps = 0.5;      // of those made while the motor was recorded
  std::size_t min_sweeps = 2;
  double min_scan_lines = kMinDistinctLines;
  double max_beam_time_sigma_units = 1;
  // The coarse search.
  double max_line_spread_deg = 5;  // rings and slices of turns repeat themselves to a degree
  double min_cost_depth = 0.15;    // of the median; 0.68 to 0.86 of simulated rooms and walks (thresholds)
  double min_lines_a_sweep = 15;   // of a 2D scanner; with more, simulated rooms have a clear valley
  double max_distance_m = 0.1;     // of sweeps at best: a third of the most that a distance counts for
  double max_rival_depth = 0.2;    // of the minimum's; no simulated room or walk has one (thresholds)
  double min_rival_apart_units = 8;
  // The kind of rig.
  std::size_t min_walk_sweeps = 12;  // besides those in which tracking settles
  double max_motion_sigma_units = 1;
  // The least squares.
  std::size_t min_matches = 100;     // four for each of the 24 views that are resampled at most
  double usual_residual_noises = 3;  // beyond, sigma covers what the noise does not explain
  double max_residual_noises = 5;    // 0.07 to 0.8 of simulated rooms, 2.8 of a real tilting scanner
  double min_lever = 0.05;           // of the reach; 0.38 to 0.61 of simulated rooms and walks (thresholds)
  // A walk.
  std::size_t min_tracked_sweeps = 20;
  double max_hopeless_units = 5;   // of what bends of the path leave, before it is solved for
  double sharpest_side_units = 3;  // where e is compared: figure 6 of the paper clearly changes by then
  // The paper's criteria.
  double max_criteria_apart_units = 3;
  double min_roll_slope = 0.3;       // of 2 omega; 1.1 of simulated rooms (thresholds)
  double max_sweeps_apart_m = 0.15;  // five times the largest d of the paper's table 1 (thresholds)
  // The answer.
  double max_sigma_units = 1;
  double max_change_s = 1e-3;    // of the offset over the recording: blurs a map visibly
  double min_change_sigmas = 3;  // of the offset, and of the drift
  double min_window_sigmas = 5;  // of one window among ten
  // Several recordings.
  double max_chi_square_sigmas =
      6;  // above its mean; 1.6 of rigs at random, 4 to 80,000 with another (together)
};
inline constexpr Limits kLimits;

}  // namespace sweepscope
