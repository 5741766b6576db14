#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

namespace sweepscope::simulation {

/// How a motor turns.
enum class MotorKind {
  kTriangle,   // constant speed, reversed at once
  kTrapezoid,  // constant speed, reversed with a finite acceleration
  kSine,
  kOneWay,  // constant speed, never reversed
  kStuck,   // does not move
};

/// The kind of that name, as --motor spells it; absent: there is none.
std::optional<MotorKind> motor_kind(std::string_view name);
/// As --motor spells it.
std::string_view name_of(MotorKind kind);
/// All of them.
std::vector<std::string_view> motor_names();

/// The part of a sweep that one reversal of the trapezoid takes.
inline constexpr double kReversalOfSweep = 0.16;

/// The axis that a motor turns about, in the base frame.
enum class MotorAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

/// "x", "-x" and so on.
std::optional<MotorAxis> motor_axis(std::string_view name);
/// "x", "-x" and so on.
std::string_view name_of(MotorAxis axis);
/// 0 for x, 1 for y, 2 for z, whichever way round.
constexpr int index_of(MotorAxis axis) {
  return static_cast<int>(axis) % 3;
}
/// Whether it points against x, y or z.
constexpr bool is_negative(MotorAxis axis) {
  return axis >= MotorAxis::kMinusX;
}

/// A motor whose speed varies slowly (0.05 to 1 Hz) and at random, by at most the fraction `part`.
struct Unevenness {
  double part = 0;         // 0 to 1
  std::uint64_t seed = 1;  // equal seeds vary alike
};

/// The speeds of a motor that turns one way, over a recording of `duration_s`: each for an equal part of it,
/// with changes of 0.3 s between, or evenly from one to the next (`ramp`) from the first at its start to the
/// last at its end. Before and after it keeps the first and the last.
struct SpeedCourse {
  std::vector<double> speeds_radps;  // empty: half a turn in sweep_s
  bool ramp = false;                 // evenly from one speed to the next
  double duration_s = 0;             // of the recording
};

/// A time in which a motor stands still; it goes on where it stopped.
struct Rest {
  double from_s = 0, to_s = 0;  // true time
};

/// A motor that moves in steps, each from one end of its swing on: a rest, and then an even motion for the
/// rest of the step's time.
struct Steps {
  double step_s = 0;   // of a whole step; 0: none
  double dwell_s = 0;  // of the rest
};

/// The motor's true angle over true time. It swings by reach_rad to either side of 0 deg, from one end to the
/// other in sweep_s; one that turns one way makes half a turn in sweep_s. phase_s, in [0, 2 sweep_s), is how
/// long after a passage through 0 deg, upwards, true time 0 falls.
class Motor {
 public:
  /// See the class.
  Motor(MotorKind kind, double sweep_s, double phase_s, const Unevenness& uneven = {},
        const SpeedCourse& course = {}, double reach_rad = std::numbers::pi / 2, const Rest& rest = {},
        const Steps& steps = {});

  /// The reading of an ideal encoder without steps, on the motor's side of the gears.
  double angle_rad(double t_s) const;
  /// The true angle of the laser: it lags by the gears' play, backlash_rad, after every reversal.
  double laser_angle_rad(double t_s, double backlash_rad) const;

 private:
  struct Swing {
    double angle_rad;
    bool upwards;
  };
  struct Wave {
    double rate_radps, phase_rad, amplitude_s;
  };
  /// Between this and the next one the speed changes evenly.
  struct SpeedKnot {
    double t_s, speed_radps, angle_rad;
  };
  Swing swing(double t_s) const;
  double one_way_rad(double t_s) const;
  /// The time that a motor of constant speed, which never rests, takes to the angle of this one at t_s.
  double warped_s(double t_s) const;
  /// The same of a motor that moves in steps, since it left an end of its swing; one that turns one way, 0
  /// deg.
  double stepped_s(double since_end_s) const;

  MotorKind kind_;
  double sweep_s_, phase_s_, reach_rad_;
  std::vector<Wave> waves_;
  Rest rest_;
  Steps steps_;
  std::vector<SpeedKnot> knots_;  // of a motor that turns one way
};

}  // namespace sweepscope::simulation
