#include "core/simulation/motion/motor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/geometry/motor_profile.hpp"
#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

constexpr double kHalfTurn_rad = kPi;
constexpr std::uint64_t kUnevenPurpose = 7;

constexpr std::array kNames = {
    std::pair{MotorKind::kTriangle, std::string_view("triangle")},
    std::pair{MotorKind::kTrapezoid, std::string_view("trapezoid")},
    std::pair{MotorKind::kSine, std::string_view("sine")},
    std::pair{MotorKind::kOneWay, std::string_view("one-way")},
    std::pair{MotorKind::kStuck, std::string_view("stuck")},
};

constexpr std::array<std::string_view, 6> kAxes{"x", "y", "z", "-x", "-y", "-z"};  // as MotorAxis

/// The angle u sweeps after the middle of an upward sweep, u in [-1/2, 1/2], as a part of the reach.
double trapezoid(double u) {
  // Straight up to r/2 before the reversal, a parabola from there; the speed follows from reaching 1 at u =
  // 1/2.
  constexpr double kSpeed = 1 / (0.5 - kReversalOfSweep / 4);
  const double into_reversal = std::abs(u) - (0.5 - kReversalOfSweep / 2);
  double reached = kSpeed * std::abs(u);
  if (into_reversal > 0) reached -= kSpeed / kReversalOfSweep * into_reversal * into_reversal;
  return u < 0 ? -reached : reached;
}

struct TimedSpeed {
  double t_s, speed_radps;
};

/// Where the speed begins or ends to change.
std::vector<TimedSpeed> timed_speeds(const SpeedCourse& course) {
  constexpr double kChange_s = 0.3;
  std::vector<TimedSpeed> timed;
  const auto count = static_cast<double>(course.speeds_radps.size());
  for (std::size_t i = 0; i < course.speeds_radps.size(); ++i) {
    const double speed_radps = course.speeds_radps[i], number = static_cast<double>(i);
    if (course.ramp) {
      timed.push_back({count > 1 ? course.duration_s * number / (count - 1) : 0, speed_radps});
      continue;
    }
    const double part_s = course.duration_s / count, half_change_s = std::min(kChange_s, part_s) / 2;
    timed.push_back({part_s * number + half_change_s, speed_radps});
    timed.push_back({part_s * (number + 1) - half_change_s, speed_radps});
  }
  return timed;
}

}  // namespace

std::optional<MotorKind> motor_kind(std::string_view name) {
  for (const auto& [kind, its_name] : kNames)
    if (its_name == name) return kind;
  return std::nullopt;
}

std::string_view name_of(MotorKind kind) {
  return std::find_if(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.first == kind; })
      ->second;
}

std::vector<std::string_view> motor_names() {
  std::vector<std::string_view> names;
  names.reserve(kNames.size());
  for (const auto& [kind, name] : kNames) names.push_back(name);
  return names;
}

std::optional<MotorAxis> motor_axis(std::string_view name) {
  const auto found = std::ranges::find(kAxes, name);
  if (found == kAxes.end()) return std::nullopt;
  return static_cast<MotorAxis>(found - kAxes.begin());
}

std::string_view name_of(MotorAxis axis) {
  return kAxes[static_cast<std::size_t>(axis)];
}

Motor::Motor(MotorKind kind, double sweep_s, double phase_s, const Unevenness& uneven,
             const SpeedCourse& course, double reach_rad, const Rest& rest, const Steps& steps)
    : kind_(kind), sweep_s_(sweep_s), phase_s_(phase_s), reach_rad_(reach_rad), rest_(rest), steps_(steps) {
  for (const auto& [t_s, speed_radps] : timed_speeds(course)) {
    const SpeedKnot before = knots_.empty() ? SpeedKnot{t_s, speed_radps, 0} : knots_.back();
    const double turned_rad = (t_s - before.t_s) * (before.speed_radps + speed_radps) / 2;
    knots_.push_back({t_s, speed_radps, before.angle_rad + turned_rad});
  }
  constexpr int kWaves = 5;
  Random random(uneven.seed, kUnevenPurpose, 0);
  for (int i = 0; uneven.part > 0 && i < kWaves; ++i) {
    const double rate_radps = 2 * kPi * (0.05 + 0.95 * random.uniform());
    const double phase_rad = 2 * kPi * random.uniform();
    waves_.push_back({rate_radps, phase_rad, uneven.part / kWaves / rate_radps});
  }
}

double Motor::warped_s(double t_s) const {
  if (t_s > rest_.from_s) t_s = std::max(rest_.from_s, t_s - (rest_.to_s - rest_.from_s));
  double warped_s = t_s;
  for (const Wave& wave : waves_)
    warped_s += wave.amplitude_s * sin_cos(wave.rate_radps * t_s + wave.phase_rad).sin;
  return warped_s;
}

double Motor::stepped_s(double since_end_s) const {
  return steps_.step_s > 0 ? evenly_s(since_end_s, steps_.step_s, steps_.dwell_s) : since_end_s;
}

double Motor::one_way_rad(double t_s) const {
  if (knots_.empty()) return kHalfTurn_rad * stepped_s(warped_s(t_s) + phase_s_) / sweep_s_;
  const double even_s = warped_s(t_s), first_rad = kHalfTurn_rad * phase_s_ / sweep_s_;
  const auto next =
      std::find_if(knots_.begin(), knots_.end(), [&](const SpeedKnot& knot) { return knot.t_s > even_s; });
  const SpeedKnot& from = next == knots_.begin() ? *next : *(next - 1);
  const double since_s = even_s - from.t_s;
  double turned_rad = from.speed_radps * since_s;
  if (next != knots_.begin() && next != knots_.end())
    turned_rad += (next->speed_radps - from.speed_radps) / (next->t_s - from.t_s) * since_s * since_s / 2;
  return first_rad + from.angle_rad + turned_rad;
}

Motor::Swing Motor::swing(double t_s) const {
  if (kind_ == MotorKind::kOneWay) return {one_way_rad(t_s), true};
  const double half_s = sweep_s_ / 2;  // from an end to the middle
  const double sweeps = (stepped_s(warped_s(t_s) + phase_s_ + half_s) - half_s) / sweep_s_;
  if (kind_ == MotorKind::kStuck) return {2 * reach_rad_ * phase_s_ / sweep_s_, true};
  const double nearest = std::floor(sweeps + 0.5);
  const double u = sweeps - nearest;
  const bool upwards = std::fmod(nearest, 2.0) == 0;
  double part = 2 * u;
  if (kind_ == MotorKind::kTrapezoid) part = trapezoid(u);
  if (kind_ == MotorKind::kSine) part = sin_cos(kPi * u).sin;
  return {reach_rad_ * (upwards ? part : -part), upwards};
}

double Motor::angle_rad(double t_s) const {
  return swing(t_s).angle_rad;
}

double Motor::laser_angle_rad(double t_s, double backlash_rad) const {
  const auto [angle_rad, upwards] = swing(t_s);
  if (kind_ == MotorKind::kStuck) return angle_rad;
  const double half_rad = backlash_rad / 2;
  if (kind_ == MotorKind::kOneWay) return angle_rad - half_rad;
  // Upwards the laser hangs back, but stays where the last downward sweep left it until the play is used up.
  return upwards ? std::max(angle_rad - half_rad, half_rad - reach_rad_)
                 : std::min(angle_rad + half_rad, reach_rad_ - half_rad);
}

}  // namespace sweepscope::simulation
