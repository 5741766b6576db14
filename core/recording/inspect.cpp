#include "core/recording/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/numbers.hpp"
#include "core/recording/stream_stamps.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {
namespace {

void take_stamps(const StreamStamps& stamps, StreamSummary& stream) {
  stream.stamp = stamps.used;
  stream.median_period_s = stamps.median_period_s;
  stream.receive_minus_header_s = stamps.receive_minus_header_s;
  stream.receive_jitter_s = stamps.receive_jitter_s;
}

/// The median of the usable ranges, from at most about a million of them.
double median_range_m(const std::vector<float>& ranges_m) {
  constexpr std::size_t kMost = 1'000'000;
  const std::size_t step = ranges_m.size() / kMost + 1;
  std::vector<double> sample_m;
  for (std::size_t i = 0; i < ranges_m.size(); i += step) {
    if (!std::isnan(ranges_m[i])) sample_m.push_back(double{ranges_m[i]});
  }
  return median(std::move(sample_m));
}

LaserSummary inspect_laser(const Recording& recording) {
  const ReadReport& report = recording.report;
  LaserSummary laser;
  take_stamps(report.laser_stamps, laser);
  laser.topic = recording.rig.laser.topic.value_or("");
  laser.stamp_at = recording.rig.laser.stamp_at;
  laser.used = recording.scans.size();
  laser.gaps = report.scan_gaps;
  laser.longest_gap_s = report.longest_scan_gap_s;
  laser.out_of_order = report.scans_out_of_order;
  laser.doubled = report.scans_doubled;
  laser.dropped = report.scans_dropped;
  laser.scans_without_motor = report.scans_without_motor;
  laser.beam_time_doubt_s = report.beam_time_doubt_s;
  laser.nan = report.nan_ranges;
  laser.infinite = report.infinite_ranges;
  laser.zero = report.zero_ranges;
  laser.out_of_range = report.out_of_range_ranges;
  laser.intensities = report.intensities || !recording.intensities.empty();
  laser.beams = recording.ranges_m.size();
  laser.usable_beams = static_cast<std::size_t>(
      std::ranges::count_if(recording.ranges_m, [](float range_m) { return !std::isnan(range_m); }));
  laser.median_range_m = median_range_m(recording.ranges_m);
  if (recording.scans.empty()) return laser;
  const auto [fewest, most] = std::ranges::minmax(recording.scans, {}, &LaserScan::beams);
  laser.fewest_beams = fewest.beams;
  laser.most_beams = most.beams;
  const LaserScan& first = recording.scans.front();
  laser.first_beam_deg = first.beam_angle_rad(0) * kDegPerRad;
  laser.last_beam_deg = first.beam_angle_rad(first.beams - 1.0) * kDegPerRad;
  laser.duration_s = recording.scans.back().first_beam_s - first.first_beam_s;
  std::vector<double> scans_s, times_s;
  for (const LaserScan& scan : recording.scans) {
    scans_s.push_back(scan.last_beam_s() - scan.first_beam_s);
    if (scan.ring == first.ring) times_s.push_back(scan.first_beam_s);
  }
  if (!recording.directions.empty()) {
    std::set<std::uint16_t> rings;
    for (const LaserScan& scan : recording.scans) rings.insert(scan.ring);
    laser.rings = rings.size();
  }
  laser.uneven_s = unevenness_s(times_s);
  laser.scan_s = median(std::move(scans_s));
  return laser;
}

MotorSummary inspect_motor(const Recording& recording, const MotorMotion& motion) {
  const ReadReport& report = recording.report;
  const MotorTrack& track = recording.motor;
  MotorSummary motor;
  take_stamps(report.motor_stamps, motor);
  motor.topic = recording.rig.motor.topic.value_or("");
  motor.joint = recording.rig.motor.joint.value_or("");
  motor.used = track.time_s.size();
  motor.gaps = report.motor_gaps;
  motor.longest_gap_s = report.longest_motor_gap_s;
  motor.out_of_order = report.motor_out_of_order;
  motor.doubled = report.motor_doubled;
  motor.dropped = report.motor_dropped;
  motor.unwrapped = report.motor_unwrapped;
  if (track.time_s.empty()) return motor;
  motor.duration_s = track.time_s.back() - track.time_s.front();
  const auto [least_rad, most_rad] = std::ranges::minmax(track.angle_rad);
  motor.least_deg = least_rad * kDegPerRad;
  motor.most_deg = most_rad * kDegPerRad;
  motor.median_speed_deg_s = motion.median_speed_rad_s * kDegPerRad;
  motor.reversals = motion.sweeps.empty() ? 0 : motion.sweeps.size() - 1;
  if (motor.whole_sweeps() > 0) motor.median_sweep_s = motion.median_sweep_s;
  motor.turns = !motion.sweeps.empty() && motor.most_deg - motor.least_deg > 1;
  motor.one_way = motor.reversals == 0 && motor.most_deg - motor.least_deg > 360;
  return motor;
}

/// What stands in the way of any estimate; empty where nothing does.
std::vector<std::string> obstacles(const LaserSummary& laser, const MotorSummary& motor) {
  if (!motor.turns) return {"The motor does not turn: there is no offset to see."};
  if (motor.one_way) {
    return {
        "The motor turns one way only: the offset cannot be told from the encoder's zero. Record it turning "
        "back "
        "and forth."};
  }
  if (motor.reversals == 0) return {"The motor never turns back: there are no two sweeps to compare."};
  if (laser.used == laser.scans_without_motor) {
    return {"No scan has motor samples around it at offset 0: choose other stamps."};
  }
  return {};
}

constexpr double kFewestSamples = 4, kFewSamples = 8;  // of the motor, a sweep

/// 0 where there is no whole sweep.
double samples_a_sweep(const MotorSummary& motor) {
  return motor.median_period_s > 0 ? motor.median_sweep_s / motor.median_period_s : 0;
}

/// Why an estimate will be refused though nothing obvious stands in its way; empty where none is known.
std::string refusal(const LaserSummary& laser, const MotorSummary& motor, double distinct_lines) {
  if (laser.stamp == StampSource::kReceive && laser.uneven_s > laser.median_period_s / 4)
    return fmt::format(
        "Expect a refusal: the scans' receive times come unevenly, by up to {:.0f} ms nine times in ten, "
        "where a scan takes {:.0f} ms.",
        1000 * laser.uneven_s, 1000 * laser.median_period_s);
  constexpr double kLeastUnit_ms = 1, kUnit_deg = 0.36;  // what an answer must be surer than
  if (const double doubt_ms = 1000 * laser.beam_time_doubt_s;
      doubt_ms / 2 > std::max(kLeastUnit_ms, kUnit_deg / motor.deg_per_ms()))
    return fmt::format(
        "Expect a refusal: when the beams were fired is not known, the last one of a scan to {:.1f} ms only; "
        "give laser.time_increment_s in a rig file.",
        doubt_ms);
  if (const double samples = samples_a_sweep(motor); samples > 0 && samples < kFewestSamples)
    return fmt::format("Expect a refusal: the motor is sampled {:.1f} times a sweep only.", samples);
  if (distinct_lines < kLeastDistinctLines)
    return fmt::format(
        "Expect a refusal: all sweeps of a direction see the same {:.2g} scan lines; a slower motor, or "
        "sweeps that last a little longer or shorter, would show more.",
        distinct_lines);
  return "";
}

std::vector<std::string> expect(const LaserSummary& laser, const MotorSummary& motor, double distinct_lines) {
  std::vector<std::string> lines = obstacles(laser, motor);
  if (!lines.empty()) return lines;
  // The paper's rig repeats to 0.3 ms (standard deviation) at 360 deg/s.
  constexpr double kRepeatable_deg = 0.1;
  const double millimetres = laser.median_range_m * motor.deg_per_ms() / kDegPerRad * 1000;
  lines.push_back(
      fmt::format("1 ms of offset turns a scan by {:.3g} deg: {:.2g} mm at the median range of {:.3g} m.",
                  motor.deg_per_ms(), millimetres, laser.median_range_m));
  std::string refused = refusal(laser, motor, distinct_lines);
  lines.push_back(!refused.empty()
                      ? std::move(refused)
                      : fmt::format("Expect an offset good to about {:.2g} ms ({} deg of the motor's angle).",
                                    kRepeatable_deg / motor.deg_per_ms(), kRepeatable_deg));
  if (motor.median_sweep_s > 0) {
    lines.push_back(fmt::format(
        "Offsets up to {:.4g} ms to either side can be told apart (a quarter of the motor's period).",
        1000 * motor.median_sweep_s / 2));
  }
  if (const double samples = samples_a_sweep(motor); samples >= kFewestSamples && samples <= kFewSamples)
    lines.push_back(fmt::format(
        "The motor is sampled {:.1f} times a sweep only, which costs accuracy: sample it every {:.2g} s.",
        samples, motor.median_sweep_s / (2 * kFewSamples)));
  constexpr std::size_t kStanding = 8, kMoving = 40;
  if (motor.whole_sweeps() < kStanding) {
    lines.push_back(
        fmt::format("{} whole sweeps are few: {} of a standing rig or {} of a moving one make a good set.",
                    motor.whole_sweeps(), kStanding, kMoving));
  } else if (motor.whole_sweeps() < kMoving) {
    lines.push_back(fmt::format("{} whole sweeps are enough of a standing rig; a moving one should give {}.",
                                motor.whole_sweeps(), kMoving));
  }
  for (const auto& [stream, name] :
       {std::pair<const StreamSummary&, const char*>{laser, "scans'"}, {motor, "motor's"}}) {
    if (stream.stamp != StampSource::kReceive || !stream.receive_jitter_s) continue;
    lines.push_back(fmt::format("The {} receive times jitter by {:.2g} ms, which goes into the answer.", name,
                                1000 * *stream.receive_jitter_s));
  }
  return lines;
}

}  // namespace

RecordingSummary inspect(const Recording& recording) {
  RecordingSummary summary;
  summary.name = recording.name;
  summary.topics = recording.report.topics;
  summary.warnings = recording.report.warnings;
  summary.laser = inspect_laser(recording);
  const MotorMotion motion = find_sweeps(recording.motor);
  summary.motor = inspect_motor(recording, motion);
  summary.expectations = expect(summary.laser, summary.motor, distinct_lines(recording, motion, 0));
  return summary;
}

}  // namespace sweepscope
