#pragma once

#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// Where the motor turned round. Between two of them lies a sweep.
struct MotorReversal {
  double time_s = 0;  // the middle of the time in which the motor stood there
  double angle_rad = 0;
};

/// The motor's reversals in the order of time. Only turning back by more than a tenth of the track's whole
/// range, and by more than 1 deg, counts, so that noise, encoder steps and overshoot do not.
std::vector<MotorReversal> motor_reversals(const MotorTrack& motor);

/// The median of the motor's speed while it turns, rad/s: of the steps over five samples, those that are at
/// least a tenth as fast as the fast ones (their 95th percentile). 0 where it does not turn.
double median_motor_speed_rad_s(const MotorTrack& motor);

}  // namespace sweepscope
