#include "core/recording/inspect.hpp"

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
  constexpr std::size_t kMax = 1'000'000;
  const std::size_t step = ranges_m.size() / kMax + 1;
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
  laser.duplicates = report.scans_duplicate;
  laser.dropped = report.scans_dropped;
  laser.scans_without_motor = report.scans_without_motor;
  laser.beam_time_doubt_s = report.beam_time_doubt_s;
  laser.readings = report.readings;
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
  laser.min_beams = fewest.beams;
  laser.max_beams = most.beams;
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
  motor.joint = recording.rig.motor.profile ? "profile" : recording.rig.motor.joint.value_or("");
  motor.used = track.time_s.size();
  motor.gaps = report.motor_gaps;
  motor.longest_gap_s = report.longest_motor_gap_s;
  motor.out_of_order = report.motor_out_of_order;
  motor.duplicates = report.motor_duplicate;
  motor.dropped = report.motor_dropped;
  motor.unwrapped = report.motor_unwrapped;
  motor.repeated = report.motor_repeated;
  motor.of_others = report.motor_of_others;
  if (track.time_s.empty()) return motor;
  motor.duration_s = track.time_s.back() - track.time_s.front();
  const auto [min_rad, max_rad] = std::ranges::minmax(track.angle_rad);
  motor.min_deg = min_rad * kDegPerRad;
  motor.max_deg = max_rad * kDegPerRad;
  motor.median_speed_deg_s = motion.median_speed_rad_s * kDegPerRad;
  motor.reversals = motion.sweeps.empty() || motion.one_way() ? 0 : motion.sweeps.size() - 1;
  if (motor.whole_sweeps() > 0) motor.median_sweep_s = motion.median_sweep_s;
  motor.turns = !motion.sweeps.empty() && motor.max_deg - motor.min_deg > 1;
  motor.one_way = motor.reversals == 0 && motor.max_deg - motor.min_deg > 360;
  return motor;
}

}  // namespace

RecordingSummary inspect(const Recording& recording) {
  RecordingSummary summary;
  summary.name = recording.name;
  summary.topics = recording.report.topics;
  summary.warnings = recording.report.warnings;
  summary.laser = inspect_laser(recording);
  const MotorMotion motion = find_sweeps(recording);
  summary.motor = inspect_motor(recording, motion);
  return summary;
}

}  // namespace sweepscope
