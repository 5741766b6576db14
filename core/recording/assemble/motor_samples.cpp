#include "core/recording/assemble/motor_samples.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

/// Takes whole turns out of jumps between neighbouring samples.
void unwrap(MotorTrack& motor, double longest_step_s, ReadReport& report) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double turned_rad = 0;
  double before_rad = motor.angle_rad.front();
  for (std::size_t i = 1; i < motor.time_s.size(); ++i) {
    const double jump_rad = motor.angle_rad[i] - before_rad;
    before_rad = motor.angle_rad[i];
    if (std::abs(jump_rad) > 0.75 * kTurn && motor.time_s[i] - motor.time_s[i - 1] <= longest_step_s) {
      turned_rad -= kTurn * std::round(jump_rad / kTurn);
      ++report.motor_unwrapped;
    }
    motor.angle_rad[i] += turned_rad;
  }
}

}  // namespace

void warn_of_source(const RawJoint& joint, Recording& recording) {
  if (joint.source != JointSource::kNumber) return;
  recording.report.warnings.push_back(
      fmt::format("{} holds plain numbers: they are multiplied by {:.6g} (the rig's motor.scale) to give "
                  "rad; whether they are measured angles or commands is not known",
                  joint.topic, recording.rig.motor.scale));
}

bool assemble_motor(const RawJoint& raw, Recording& recording) {
  ReadReport& report = recording.report;
  const Rig::Motor& rig = recording.rig.motor;
  std::vector<double> times_s, angles_rad;
  for (std::size_t i = 0; i < raw.stamps.size(); ++i) {
    const std::int64_t ns = stamp_ns(raw.stamps[i], report.motor_stamps.used);
    const double angle_rad = rig.scale * raw.positions[i] - rig.zero_deg * std::numbers::pi / 180;
    if (ns == 0 || !std::isfinite(angle_rad)) {
      ++report.motor_dropped;
      continue;
    }
    times_s.push_back(static_cast<double>(ns - recording.epoch_ns) * 1e-9);
    angles_rad.push_back(angle_rad);
  }
  const TimeOrder order = order_by_time(times_s);
  report.motor_out_of_order = order.out_of_order;
  report.motor_duplicate = order.duplicates;
  MotorTrack& motor = recording.motor;
  for (const std::size_t i : order.kept) {
    motor.time_s.push_back(times_s[i]);
    motor.angle_rad.push_back(angles_rad[i]);
  }
  if (motor.time_s.size() < 2) return false;
  const Spacing spaced = spacing(motor.time_s, kMotorGapFactor);
  report.motor_stamps.median_period_s = spaced.median_s;
  report.motor_gaps = spaced.gaps;
  report.longest_motor_gap_s = spaced.longest_gap_s;
  unwrap(motor, kMotorGapFactor * spaced.median_s, report);
  if (const Gear gear = recording.rig.gear.angles(); !gear.perfect()) motor = laser_angles(motor, gear);
  if (report.motor_dropped > 0) {
    report.warnings.push_back(
        fmt::format("{} of {} samples of joint {} were dropped: no stamp, or no finite angle",
                    report.motor_dropped, raw.stamps.size(), raw.joint));
  }
  return true;
}

}  // namespace sweepscope
