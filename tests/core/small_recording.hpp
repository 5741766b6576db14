#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/recording/recording.hpp"

namespace sweepscope::test {

inline MotorTrack track(double duration_s, double period_s, const std::function<double(double)>& angle_rad) {
  MotorTrack motor;
  for (int i = 0; i * period_s <= duration_s; ++i) {
    motor.time_s.push_back(i * period_s);
    motor.angle_rad.push_back(angle_rad(i * period_s));
  }
  return motor;
}

/// Between -1 and 1 rad, half a second each way, at -1 at 0 s.
inline double triangle_rad(double t_s) {
  const double phase = std::fmod(t_s, 1.0);
  return phase < 0.5 ? -1 + 4 * phase : 3 - 4 * phase;
}

/// 100 scans of three beams, 25 ms apart.
inline Recording recording_of(const MotorTrack& motor) {
  Recording recording;
  recording.name = "a.bag";
  recording.motor = motor;
  for (int i = 0; i < 100; ++i) {
    LaserScan scan;
    scan.first_beam_s = 0.025 * i;
    scan.time_increment_s = 0.001;
    scan.angle_min_rad = -std::numbers::pi / 2;
    scan.angle_increment_rad = std::numbers::pi / 2;
    scan.first_range = recording.ranges_m.size();
    scan.beams = 3;
    recording.ranges_m.insert(recording.ranges_m.end(), {2, 4, std::numeric_limits<float>::quiet_NaN()});
    recording.scans.push_back(scan);
  }
  return recording;
}

}  // namespace sweepscope::test
