#include "core/apply/clock_shift.hpp"

#include <cmath>

namespace sweepscope {
namespace {

constexpr double kNs_per_s = 1e9;

std::int64_t ns_after(std::int64_t first_ns, double time_s) {
  return first_ns + std::llround(time_s * kNs_per_s);
}

}  // namespace

double ClockShift::offset_s(std::int64_t laser_ns) const {
  double offset_s = offset_s_ + rate_ * (static_cast<double>(laser_ns - at_laser_ns_) / kNs_per_s);
  for (const ShiftStep& step : steps_) {
    if (step.laser_ns <= laser_ns && step.laser_ns > at_laser_ns_) offset_s += step.size_s;
    if (step.laser_ns > laser_ns && step.laser_ns <= at_laser_ns_) offset_s -= step.size_s;
  }
  return offset_s;
}

std::int64_t ClockShift::motor_ns(std::int64_t laser_ns) const {
  return laser_ns + std::llround(offset_s(laser_ns) * kNs_per_s);
}

std::int64_t ClockShift::laser_ns(std::int64_t motor_ns) const {
  // Fixed-point iteration: rates are at most 1 %, so that each iteration divides the error by 100. Beside a
  // step of the offset it may alternate, and the last value is used.
  constexpr int kSteps = 8;
  std::int64_t laser_ns = motor_ns - std::llround(offset_s(motor_ns) * kNs_per_s);
  for (int i = 0; i < kSteps; ++i) {
    const std::int64_t next = motor_ns - std::llround(offset_s(laser_ns) * kNs_per_s);
    if (next == laser_ns) break;
    laser_ns = next;
  }
  return laser_ns;
}

ClockShift clock_shift(const AppliedOffset& offset, std::int64_t first_ns, std::int64_t last_ns) {
  if (!offset.changes()) return ClockShift(offset.offset_s);
  const std::int64_t middle_ns =
      offset.middle_s ? ns_after(first_ns, *offset.middle_s) : first_ns + (last_ns - first_ns) / 2;
  std::vector<ShiftStep> steps;
  for (const AppliedOffset::Jump& jump : offset.jumps)
    steps.push_back({ns_after(first_ns, jump.time_s), jump.size_s});
  return {offset.offset_s, middle_ns, offset.rate, std::move(steps)};
}

}  // namespace sweepscope
