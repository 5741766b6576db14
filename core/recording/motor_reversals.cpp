#include "core/recording/motor_reversals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kLeastTurn_rad = std::numbers::pi / 180;

/// The reversal about sample `i`, an extreme: in the middle of the samples around it that are next to it in
/// angle.
MotorReversal reversal_at(const MotorTrack& motor, std::size_t i, double near_rad) {
  const auto near = [&](std::size_t j) {
    return std::abs(motor.angle_rad[j] - motor.angle_rad[i]) <= near_rad;
  };
  std::size_t first = i, last = i;
  while (first > 0 && near(first - 1)) --first;
  while (last + 1 < motor.time_s.size() && near(last + 1)) ++last;
  return {(motor.time_s[first] + motor.time_s[last]) / 2, motor.angle_rad[i]};
}

}  // namespace

std::vector<MotorReversal> motor_reversals(const MotorTrack& motor) {
  std::vector<MotorReversal> reversals;
  if (motor.angle_rad.empty()) return reversals;
  const auto [least, most] = std::ranges::minmax(motor.angle_rad);
  const double turn_rad = std::max(0.1 * (most - least), kLeastTurn_rad);
  const double near_rad = 0.005 * (most - least);
  int direction = 0;  // unknown until the motor has turned far enough
  std::size_t lowest = 0, highest = 0;
  for (std::size_t i = 1; i < motor.angle_rad.size(); ++i) {
    const double angle_rad = motor.angle_rad[i];
    if (angle_rad < motor.angle_rad[lowest]) lowest = i;
    if (angle_rad > motor.angle_rad[highest]) highest = i;
    if (direction >= 0 && motor.angle_rad[highest] - angle_rad > turn_rad) {
      if (direction > 0) reversals.push_back(reversal_at(motor, highest, near_rad));
      direction = -1;
      lowest = i;
    } else if (direction <= 0 && angle_rad - motor.angle_rad[lowest] > turn_rad) {
      if (direction < 0) reversals.push_back(reversal_at(motor, lowest, near_rad));
      direction = 1;
      highest = i;
    }
  }
  return reversals;
}

double median_motor_speed_rad_s(const MotorTrack& motor) {
  constexpr std::size_t kStep = 5;  // evens out encoder steps and jitter
  std::vector<double> speeds_rad_s;
  for (std::size_t i = kStep; i < motor.time_s.size(); ++i) {
    const double turned_rad = motor.angle_rad[i] - motor.angle_rad[i - kStep];
    speeds_rad_s.push_back(std::abs(turned_rad) / (motor.time_s[i] - motor.time_s[i - kStep]));
  }
  if (speeds_rad_s.empty()) return 0;
  const auto fast = speeds_rad_s.begin() + std::ssize(speeds_rad_s) * 95 / 100;
  std::nth_element(speeds_rad_s.begin(), fast, speeds_rad_s.end());
  const double slowest_rad_s = 0.1 * *fast;
  std::erase_if(speeds_rad_s, [&](double speed_rad_s) { return speed_rad_s < slowest_rad_s; });
  return median(std::move(speeds_rad_s));
}

}  // namespace sweepscope
