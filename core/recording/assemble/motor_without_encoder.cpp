#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numbers.hpp"
#include "core/recording/assemble/motor_samples.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kWholeTurn_rad = 2 * std::numbers::pi;
constexpr double kSampleStep_s = 0.005;  // of the samples: angles are linear in between

// When a turn was marked: each message, or where its values are of two kinds each rise.
std::vector<double> marks_s(const RawJoint& raw, const Recording& recording) {
  std::vector<double> values = raw.positions;
  std::ranges::sort(values);
  const auto [last, end] = std::ranges::unique(values);
  const bool two_values = last - values.begin() == 2;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < raw.stamps.size(); ++i) {
    const std::int64_t ns = stamp_ns(raw.stamps[i], recording.report.motor_stamps.used);
    const bool rises = i > 0 && raw.positions[i] > raw.positions[i - 1];
    if (ns != 0 && (rises || !two_values))
      times_s.push_back(static_cast<double>(ns - recording.epoch_ns) * 1e-9);
  }
  const TimeOrder order = order_by_time(times_s);
  std::vector<double> kept_s;
  for (const std::size_t i : order.kept) kept_s.push_back(times_s[i]);
  return kept_s;
}

// Turns at a time between marks i and i + 1: a cubic whose speed at a mark is that between its neighbours.
double turns_at(const std::vector<double>& marks_s, std::size_t i, double t_s) {
  const auto speed = [&](std::size_t at) {
    const std::size_t from = at == 0 ? 0 : at - 1, to = std::min(at + 1, marks_s.size() - 1);
    return double(to - from) / (marks_s[to] - marks_s[from]);
  };
  const double step_s = marks_s[i + 1] - marks_s[i], u = (t_s - marks_s[i]) / step_s;
  const double begins = speed(i) * step_s, ends = speed(i + 1) * step_s;
  return double(i) + u * (begins + u * (3 - 2 * begins - ends + u * (begins + ends - 2)));
}

}  // namespace

bool assemble_index(const RawJoint& raw, Recording& recording) {
  const std::vector<double> at_s = marks_s(raw, recording);
  if (at_s.size() < 2) return false;
  MotorTrack& motor = recording.motor;
  const double zero_rad = recording.rig.motor.zero_deg * kRadPerDeg,
               direction = recording.rig.motor.scale < 0 ? -1 : 1;
  for (std::size_t i = 0; i + 1 < at_s.size(); ++i) {
    const auto steps = std::max(1.0, std::ceil((at_s[i + 1] - at_s[i]) / kSampleStep_s));
    for (double step = 0; step < steps; ++step) {
      const double t_s = at_s[i] + (at_s[i + 1] - at_s[i]) * step / steps;
      motor.time_s.push_back(t_s);
      motor.angle_rad.push_back(direction * kWholeTurn_rad * turns_at(at_s, i, t_s) - zero_rad);
    }
  }
  motor.time_s.push_back(at_s.back());
  motor.angle_rad.push_back(direction * kWholeTurn_rad * double(at_s.size() - 1) - zero_rad);
  recording.report.motor_stamps.median_period_s = kSampleStep_s;
  recording.report.warnings.push_back(fmt::format(
      "the motor's angle is known once a turn, from {} marks on {}: in between it is assumed to turn evenly",
      at_s.size(), raw.topic));
  return true;
}

void turn_by_profile(Recording& recording) {
  constexpr double kMaxMargin_s = 60;
  const MotorProfile& profile = *recording.rig.motor.profile;
  const double first_s = recording.scans.front().first_beam_s, last_s = recording.scans.back().last_beam_s();
  const double margin_s = std::min(kMaxMargin_s, std::max(1.0, profile.sweep_s()));
  const double start_s = first_s + profile.start_s.value_or(0);
  const auto samples = static_cast<std::size_t>((last_s - first_s + 2 * margin_s) / kSampleStep_s) + 2;
  MotorTrack& motor = recording.motor;
  motor.time_s.clear();
  motor.angle_rad.clear();
  for (std::size_t i = 0; i < samples; ++i) {
    const double t_s = first_s - margin_s + double(i) * kSampleStep_s;
    motor.time_s.push_back(t_s);
    motor.angle_rad.push_back(profile.angle_rad(t_s - start_s) - recording.rig.motor.zero_deg * kRadPerDeg);
  }
}

void assemble_profile(Recording& recording) {
  turn_by_profile(recording);
  const MotorProfile& profile = *recording.rig.motor.profile;
  const double start_s = recording.scans.front().first_beam_s + profile.start_s.value_or(0);
  recording.report.motor_stamps.median_period_s = kSampleStep_s;
  std::string text = "the motor's angle is that of the rig file's profile, not measured";
  if (profile.steps_per_turn > 0) {
    const auto resting = std::ranges::count_if(recording.scans, [&](const LaserScan& scan) {
      return profile.rests(scan.first_beam_s - start_s) && profile.rests(scan.last_beam_s() - start_s);
    });
    text += fmt::format(": {} of {} scans lie within a rest at offset 0", resting, recording.scans.size());
  }
  recording.report.warnings.push_back(text);
}

}  // namespace sweepscope
