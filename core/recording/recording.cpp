#include "core/recording/recording.hpp"

#include <algorithm>

namespace sweepscope {
namespace {

/// All but the scans and the motor's samples.
Recording without_streams(const Recording& recording) {
  Recording result;
  result.name = recording.name;
  result.epoch_ns = recording.epoch_ns;
  result.begins_s = recording.begins_s;
  result.rig = recording.rig;
  result.report = recording.report;
  result.turn_rates = recording.turn_rates;
  result.odometry = recording.odometry;
  return result;
}

void append(const Recording& from, LaserScan scan, Recording& to) {
  const auto copy = [&](const auto& values, auto& copied) {
    if (values.empty()) return;
    const auto first = values.begin() + std::ptrdiff_t(scan.first_range);
    copied.insert(copied.end(), first, first + std::ptrdiff_t(scan.beams));
  };
  const std::size_t first_range = to.ranges_m.size();
  copy(from.ranges_m, to.ranges_m);
  copy(from.intensities, to.intensities);
  copy(from.directions, to.directions);
  scan.first_range = first_range;
  to.scans.push_back(scan);
}

double since_begin_s(const Recording& recording, const LaserScan& scan) {
  return scan.first_beam_s - recording.scans.front().first_beam_s;
}

bool holds(const RecordingPart& part, double since_s) {
  return since_s >= part.begin_s && since_s <= part.end_s;
}

MotorTrack between(const MotorTrack& motor, double from_s, double to_s) {
  const auto begin = std::ranges::lower_bound(motor.time_s, from_s) - motor.time_s.begin();
  const auto end = std::ranges::upper_bound(motor.time_s, to_s) - motor.time_s.begin();
  MotorTrack part;
  part.time_s.assign(motor.time_s.begin() + begin, motor.time_s.begin() + end);
  part.angle_rad.assign(motor.angle_rad.begin() + begin, motor.angle_rad.begin() + end);
  return part;
}

}  // namespace

Recording window(const Recording& recording, double from_s, double to_s, double motor_margin_s) {
  Recording part = without_streams(recording);
  for (const LaserScan& scan : recording.scans)
    if (holds({from_s, to_s}, since_begin_s(recording, scan))) append(recording, scan, part);
  if (part.scans.empty()) return part;
  part.begins_s += part.scans.front().first_beam_s - recording.scans.front().first_beam_s;
  part.motor = between(recording.motor, part.scans.front().first_beam_s - motor_margin_s,
                       part.scans.back().last_beam_s() + motor_margin_s);
  return part;
}

Recording part_of_whole(const Recording& recording, const RecordingPart& part) {
  return window(recording, part.begin_s - recording.begins_s, part.end_s - recording.begins_s);
}

Recording parts_of(const Recording& recording, const std::vector<RecordingPart>& parts) {
  Recording result = without_streams(recording);
  result.motor = recording.motor;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const double since_s = since_begin_s(recording, recording.scans[i]);
    const bool kept = i == 0 || i + 1 == recording.scans.size() ||
                      std::ranges::any_of(parts, [&](const auto& part) { return holds(part, since_s); });
    if (kept) append(recording, recording.scans[i], result);
  }
  return result;
}

}  // namespace sweepscope
