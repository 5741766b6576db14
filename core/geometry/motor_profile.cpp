#include "core/geometry/motor_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/kinematics.hpp"
#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

// The way of a motion that lasts 1 and goes from 0 to 1, with even acceleration for `ramp` at either end.
double ramped(double t, double ramp) {
  const double speed = 1 / (1 - ramp);
  if (t > 0.5) return 1 - ramped(1 - t, ramp);
  return t < ramp ? speed * t * t / (2 * ramp) : speed * (t - ramp / 2);
}

}  // namespace

double evenly_s(double since_start_s, double step_s, double dwell_s) {
  const double steps = std::floor(since_start_s / step_s);
  const double moves_s = step_s - dwell_s, moved_s = since_start_s - steps * step_s - dwell_s;
  return step_s * (steps + (moves_s > 0 ? std::max(0.0, moved_s / moves_s) : 0));
}

double MotorProfile::sweep_s() const {
  const double turns = between ? std::abs(between->to_deg - between->from_deg) / 360 : 0.5;
  return turns / std::abs(turns_per_s);
}

bool MotorProfile::mirrors_itself() const {
  constexpr double kWithin = 0.25;  // of a step
  const double steps = sweep_s() * std::abs(turns_per_s) * steps_per_turn;
  return std::abs(steps - std::round(steps)) < kWithin;
}

bool MotorProfile::rests(double since_start_s) const {
  if (!(steps_per_turn > 0)) return false;
  const double step_s = 1 / (std::abs(turns_per_s) * steps_per_turn);
  return since_start_s - step_s * std::floor(since_start_s / step_s) < dwell_s;
}

double MotorProfile::angle_rad(double since_start_s) const {
  double t_s = start_s ? std::max(0.0, since_start_s) : since_start_s;
  if (steps_per_turn > 0) t_s = evenly_s(t_s, 1 / (std::abs(turns_per_s) * steps_per_turn), dwell_s);
  if (!between) {
    const double ramp_way_s = start_s && ramp_s > 0 ? std::min(t_s, ramp_s) : 0;
    const double way_s = ramp_way_s > 0 ? ramp_way_s * ramp_way_s / (2 * ramp_s) + (t_s - ramp_way_s) : t_s;
    return kTurn_rad * turns_per_s * way_s;
  }
  const double sweeps = t_s / sweep_s(), whole = std::floor(sweeps);
  const double part = ramped(sweeps - whole, ramp_s / sweep_s());
  const bool back = std::fmod(whole, 2.0) != 0;
  const double from_deg = between->from_deg, way_deg = between->to_deg - between->from_deg;
  return kRadPerDeg * (from_deg + way_deg * (back ? 1 - part : part));
}

}  // namespace sweepscope
