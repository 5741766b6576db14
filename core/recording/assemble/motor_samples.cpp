#include "core/recording/assemble/motor_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "core/numbers.hpp"
#include "core/recording/assemble/motor_publishers.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

/// Takes whole turns out of jumps between neighbouring samples.
void unwrap(MotorTrack& motor, double longest_step_s, ReadReport& report) {
  double turned_rad = 0;
  double before_rad = motor.angle_rad.front();
  for (std::size_t i = 1; i < motor.time_s.size(); ++i) {
    const double jump_rad = motor.angle_rad[i] - before_rad;
    before_rad = motor.angle_rad[i];
    if (std::abs(jump_rad) > 0.75 * kTurn_rad && motor.time_s[i] - motor.time_s[i - 1] <= longest_step_s) {
      turned_rad -= kTurn_rad * std::round(jump_rad / kTurn_rad);
      ++report.motor_unwrapped;
    }
    motor.angle_rad[i] += turned_rad;
  }
}

/// Equal angles in a row.
struct Run {
  std::size_t first = 0, last = 0;  // samples
  bool repeats() const { return last > first; }
};

std::vector<Run> runs_of(const MotorTrack& motor) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < motor.angle_rad.size(); ++i)
    if (i > 0 && motor.angle_rad[i] == motor.angle_rad[i - 1])
      runs.back().last = i;
    else
      runs.push_back({i, i});
  return runs;
}

/// The encoder's step: the smallest distance between angles, or between such distances, that occurs more than
/// once; where the encoder is so fine that none does, a small quantile of the distances.
double encoder_step_rad(const MotorTrack& motor) {
  constexpr double kSame_rad = 1e-7, kQuantile = 0.05;
  std::vector<double> angles_rad = motor.angle_rad;
  std::ranges::sort(angles_rad);
  std::vector<double> gaps_rad = spacings(angles_rad);
  std::erase_if(gaps_rad, [](double gap_rad) { return gap_rad < kSame_rad; });
  if (gaps_rad.empty()) return 0;
  std::ranges::sort(gaps_rad);
  double step_rad = gaps_rad.back(), last_rad = 0;
  bool repeated = false;
  for (std::size_t i = 1; i < gaps_rad.size(); ++i) {
    if (gaps_rad[i] - gaps_rad[i - 1] > kSame_rad) continue;
    if (gaps_rad[i] - last_rad > kSame_rad) step_rad = std::min(step_rad, gaps_rad[i] - last_rad);
    last_rad = gaps_rad[i];
    repeated = true;
  }
  return repeated ? step_rad : quantile(gaps_rad, kQuantile);
}

/// Whether the angles that last a scan at least take most of the time and lie on a grid of one step,
/// as those of a motor do that goes from stop to stop to be scanned there; on its way it may send others.
bool stops_on_grid(const MotorTrack& motor, const std::vector<Run>& runs, double scan_period_s) {
  constexpr double kMost = 0.4, kOnGrid = 0.9;  // kOnGrid of 1, where all angles have one phase
  std::vector<double> stops_rad, steps_rad;
  double stopped_s = 0;
  for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
    const double lasts_s = motor.time_s[runs[i + 1].first] - motor.time_s[runs[i].first];
    if (lasts_s < scan_period_s) continue;
    stopped_s += lasts_s;
    if (!stops_rad.empty()) steps_rad.push_back(std::abs(motor.angle_rad[runs[i].first] - stops_rad.back()));
    stops_rad.push_back(motor.angle_rad[runs[i].first]);
  }
  if (steps_rad.empty() || stopped_s < kMost * (motor.time_s.back() - motor.time_s.front())) return false;
  const double median_rad = median(steps_rad);
  if (!(median_rad > 0)) return true;
  // The encoder rounds each step; many steps of a rounded one would end beside the last stop.
  std::erase_if(steps_rad, [&](double step_rad) { return std::abs(step_rad - median_rad) > median_rad / 4; });
  const double step_rad = std::accumulate(steps_rad.begin(), steps_rad.end(), 0.0) / double(steps_rad.size());
  std::complex<double> sum;
  for (const double stop_rad : stops_rad) sum += std::polar(1.0, kTurn_rad * stop_rad / step_rad);
  return std::abs(sum) > kOnGrid * double(stops_rad.size());
}

/// Whether the motor turned at about one speed before, during and after a run, by more from one sample to the
/// next than the encoder's step.
bool repeats_while_moving(const MotorTrack& motor, const Run& before, const Run& run, const Run& after,
                          double step_rad) {
  constexpr double kMaxSpeedRatio = 3, kMinSteps = 2;
  const auto speed_rad_s = [&](const Run& from, const Run& to) {
    return (motor.angle_rad[to.first] - motor.angle_rad[from.first]) /
           (motor.time_s[to.first] - motor.time_s[from.first]);
  };
  const double first = speed_rad_s(before, run), second = speed_rad_s(run, after);
  if (first * second <= 0) return false;
  const double slow = std::min(std::abs(first), std::abs(second)),
               fast = std::max(std::abs(first), std::abs(second));
  const double spacing_s = (motor.time_s[run.last] - motor.time_s[run.first]) / double(run.last - run.first);
  return fast < kMaxSpeedRatio * slow && slow * spacing_s > kMinSteps * step_rad;
}

/// The runs whose repeats are old angles sent again. Where many are, those at the reversals are, too: but not
/// those that last longer, at which the motor stood.
std::vector<char> runs_sent_again(const MotorTrack& motor, const std::vector<Run>& runs,
                                  double scan_period_s) {
  constexpr double kMany = 0.2, kLonger = 1.05;
  std::vector<char> again(runs.size(), 0);
  if (runs.size() < 3 || stops_on_grid(motor, runs, scan_period_s)) return again;
  const double step_rad = encoder_step_rad(motor);
  double longest_s = 0;
  std::size_t repeats = 0;
  const auto lasts_s = [&](const Run& run) { return motor.time_s[run.last] - motor.time_s[run.first]; };
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
    if (!runs[i].repeats()) continue;
    again[i] = repeats_while_moving(motor, runs[i - 1], runs[i], runs[i + 1], step_rad);
    if (!again[i]) continue;
    longest_s = std::max(longest_s, lasts_s(runs[i]));
    repeats += runs[i].last - runs[i].first;
  }
  if (double(repeats) < kMany * double(motor.time_s.size())) return again;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].repeats() && lasts_s(runs[i]) <= kLonger * longest_s) again[i] = 1;
  return again;
}

/// Without samples that repeat the angle before the last one while the motor turns on: a node that sends the
/// last angle it knows was overtaken by the next one.
MotorTrack without_overtaken(const MotorTrack& motor) {
  constexpr double kMinSteps = 2;
  const double min_rad = kMinSteps * encoder_step_rad(motor);
  const std::vector<double>& angles_rad = motor.angle_rad;
  MotorTrack kept;
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    if (i >= 2 && i + 1 < angles_rad.size() && angles_rad[i] == angles_rad[i - 2]) {
      const double back_rad = angles_rad[i - 1] - angles_rad[i],
                   on_rad = angles_rad[i + 1] - angles_rad[i - 1];
      if (std::abs(back_rad) > min_rad && back_rad * on_rad >= 0) continue;
    }
    kept.time_s.push_back(motor.time_s[i]);
    kept.angle_rad.push_back(angles_rad[i]);
  }
  return kept;
}

/// Leaves out samples that repeat the one before although the motor moves: they say where it was earlier.
void leave_out_repeats(const RawJoint& raw, Recording& recording) {
  const std::size_t samples = recording.motor.time_s.size();
  const MotorTrack motor = without_overtaken(recording.motor);
  const std::vector<Run> runs = runs_of(motor);
  const std::vector<char> again = runs_sent_again(motor, runs, recording.report.laser_stamps.median_period_s);
  MotorTrack kept;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t last = again[i] ? runs[i].first : runs[i].last;
    for (std::size_t sample = runs[i].first; sample <= last; ++sample) {
      kept.time_s.push_back(motor.time_s[sample]);
      kept.angle_rad.push_back(motor.angle_rad[sample]);
    }
  }
  std::size_t& repeated = recording.report.motor_repeated;
  repeated = samples - kept.time_s.size();
  if (repeated == 0) return;
  recording.report.warnings.push_back(fmt::format(
      "{} of {} samples of joint {} on {} repeat the angle before although the motor moves: old angles sent "
      "again under new stamps. They are left out",
      repeated, samples, raw.joint, raw.topic));
  recording.motor = std::move(kept);
}

/// What speaks against the angles as they were recorded.
void find_faults(const MotorTrack& motor, MotorFaults& faults) {
  const auto [min_rad, max_rad] = std::ranges::minmax(motor.angle_rad);
  faults.range_rad = max_rad - min_rad;
  std::vector<double> steps_rad;
  const double direction = motor.angle_rad.back() < motor.angle_rad.front() ? -1 : 1;
  double farthest_rad = direction * motor.angle_rad.front();
  for (std::size_t i = 1; i < motor.angle_rad.size(); ++i) {
    const double angle_rad = direction * motor.angle_rad[i];
    steps_rad.push_back(std::abs(motor.angle_rad[i] - motor.angle_rad[i - 1]));
    farthest_rad = std::max(farthest_rad, angle_rad);
    faults.returned_rad = std::max(faults.returned_rad, farthest_rad - angle_rad);
  }
  faults.median_step_rad = median(std::move(steps_rad));
}

void take_spacing(const MotorTrack& motor, ReadReport& report) {
  const Spacing spaced = spacing(motor.time_s, kMotorGapFactor);
  report.motor_stamps.median_period_s = spaced.median_s;
  report.motor_gaps = spaced.gaps;
  report.longest_motor_gap_s = spaced.longest_gap_s;
}

}  // namespace

void warn_of_source(const RawJoint& joint, Recording& recording) {
  if (joint.source != JointSource::kNumber) return;
  recording.report.warnings.push_back(fmt::format(
      "{} holds plain numbers: they are multiplied by {:.6g} (the rig's motor.scale and motor.unit) to give "
      "rad; whether they are measured angles or commands is not known",
      joint.topic, recording.rig.motor.rad_per_value()));
}

bool assemble_motor(const RawJoint& raw, Recording& recording) {
  ReadReport& report = recording.report;
  const Rig::Motor& rig = recording.rig.motor;
  std::vector<double> times_s, angles_rad;
  std::vector<std::uint16_t> publisher;
  for (std::size_t i = 0; i < raw.stamps.size(); ++i) {
    const std::int64_t ns = stamp_ns(raw.stamps[i], report.motor_stamps.used);
    const double angle_rad = rig.rad_per_value() * raw.positions[i] - rig.zero_deg * std::numbers::pi / 180;
    if (ns == 0 || !std::isfinite(angle_rad)) {
      ++report.motor_dropped;
      continue;
    }
    times_s.push_back(static_cast<double>(ns - recording.epoch_ns) * 1e-9);
    angles_rad.push_back(angle_rad);
    if (!raw.publisher.empty()) publisher.push_back(raw.publisher[i]);
  }
  keep_one_publisher(raw, {times_s, angles_rad, publisher}, report);
  const TimeOrder order = order_by_time(times_s);
  report.motor_out_of_order = order.out_of_order;
  report.motor_duplicate = order.duplicates;
  MotorTrack& motor = recording.motor;
  const auto clock = part_of_one_clock(times_s, angles_rad);
  if (clock) report.warnings.push_back(set_back_warning(*clock, times_s[order.kept[0]], raw.topic));
  for (const std::size_t i : order.kept) {
    if (clock && (times_s[i] < clock->from_s || times_s[i] > clock->to_s)) continue;
    motor.time_s.push_back(times_s[i]);
    motor.angle_rad.push_back(angles_rad[i]);
  }
  if (motor.time_s.size() < 2) return false;
  leave_out_constant(raw, motor, report);
  find_faults(motor, report.motor_faults);
  take_spacing(motor, report);
  unwrap(motor, kMotorGapFactor * report.motor_stamps.median_period_s, report);
  leave_out_repeats(raw, recording);
  if (report.motor_repeated > 0) take_spacing(motor, report);
  if (report.motor_faults.sources.empty()) report.motor_faults.sources = interleaved_sources(raw, motor);
  if (const Gear gear = recording.rig.gear.angles(); !gear.perfect()) motor = laser_angles(motor, gear);
  if (report.motor_dropped > 0) {
    report.warnings.push_back(
        fmt::format("{} of {} samples of joint {} were dropped: no stamp, or no finite angle",
                    report.motor_dropped, raw.stamps.size(), raw.joint));
  }
  return true;
}

}  // namespace sweepscope
