#pragma once

#include <optional>

namespace sweepscope {

/// The time in which an even motion comes as far as one in steps in `since_start_s`: each step takes step_s,
/// first a rest of dwell_s, which is less, and then an even motion.
double evenly_s(double since_start_s, double step_s, double dwell_s);

/// The motion of a motor without an encoder, as it was commanded. It turns one way, or back and forth between
/// two angles; evenly, or in steps with a rest after each.
struct MotorProfile {
  /// The angles between which it turns back and forth.
  struct Limits {
    double from_deg = 0, to_deg = 0;  // from < to
  };
  double turns_per_s = 0;         // mean, > 0 where the angle grows; of both directions between limits: > 0
  double turns_per_s_within = 0;  // a prior: the speed lies within this of turns_per_s; 0: it is exact
  std::optional<Limits> between;  // absent: it turns one way
  double ramp_s = 0;              // in which it gains its speed after a reversal or a start, and loses it
  double steps_per_turn = 0;      // 0: no steps
  double dwell_s = 0;             // of the time of a step, in which it rests
  std::optional<double> start_s;  // when it left its first angle, since the first scan; absent: unknown

  /// How long it takes from limit to limit, or of a motor that turns one way for half a turn.
  double sweep_s() const;
  /// The angle at a time after the start. The motion of a known start is preceded by rest; that of an unknown
  /// one goes on for ever in both directions.
  double angle_rad(double since_start_s) const;
  /// Whether its motion is its own mirror image a sweep later: not where a reversal lies within a step.
  bool mirrors_itself() const;
  /// Whether it rests after a step at a time after the start.
  bool rests(double since_start_s) const;
};

}  // namespace sweepscope
