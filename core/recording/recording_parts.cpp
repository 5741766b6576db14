#include "core/recording/recording_parts.hpp"

#include <algorithm>

namespace sweepscope {
namespace {

Recording without_streams(const Recording& recording) {
  Recording result;
  result.name = recording.name;
  result.epoch_ns = recording.epoch_ns;
  result.rig = recording.rig;
  result.report = recording.report;
  result.turn_rates = recording.turn_rates;
  result.odometry = recording.odometry;
  return result;
}

void append(const Recording& from, LaserScan scan, Recording& to) {
  const auto copy = [&](const auto& values, auto& copied) {
    const auto first = values.begin() + std::ptrdiff_t(scan.first_range);
    copied.insert(copied.end(), first, first + std::ptrdiff_t(scan.beams));
  };
  const std::size_t first_range = to.ranges_m.size();
  copy(from.ranges_m, to.ranges_m);
  if (!from.directions.empty()) copy(from.directions, to.directions);
  scan.first_range = first_range;
  to.scans.push_back(scan);
}

}  // namespace

Recording part_of(const Recording& recording, const RecordingPart& part, double motor_margin_s) {
  Recording result = without_streams(recording);
  if (recording.scans.empty()) return result;
  const double start_s = recording.scans.front().first_beam_s;
  const auto since_s = [&](const LaserScan& scan) { return scan.first_beam_s - start_s; };
  const auto first = std::ranges::lower_bound(recording.scans, part.begin_s, {}, since_s);
  const auto end = std::ranges::upper_bound(first, recording.scans.end(), part.end_s, {}, since_s);
  for (auto scan = first; scan != end; ++scan) append(recording, *scan, result);
  if (result.scans.empty()) return result;
  const MotorTrack& motor = recording.motor;
  const auto begin =
      std::ranges::lower_bound(motor.time_s, result.scans.front().first_beam_s - motor_margin_s) -
      motor.time_s.begin();
  const auto after =
      std::ranges::upper_bound(motor.time_s, result.scans.back().last_beam_s() + motor_margin_s) -
      motor.time_s.begin();
  result.motor.time_s.assign(motor.time_s.begin() + begin, motor.time_s.begin() + after);
  result.motor.angle_rad.assign(motor.angle_rad.begin() + begin, motor.angle_rad.begin() + after);
  return result;
}

Recording parts_of(const Recording& recording, const std::vector<RecordingPart>& parts) {
  Recording result = without_streams(recording);
  result.motor = recording.motor;
  if (recording.scans.empty()) return result;
  const double start_s = recording.scans.front().first_beam_s;
  const auto kept = [&](std::size_t scan) {
    if (scan == 0 || scan + 1 == recording.scans.size()) return true;
    const double since_s = recording.scans[scan].first_beam_s - start_s;
    return std::ranges::any_of(
        parts, [&](const RecordingPart& part) { return since_s >= part.begin_s && since_s <= part.end_s; });
  };
  for (std::size_t i = 0; i < recording.scans.size(); ++i)
    if (kept(i)) append(recording, recording.scans[i], result);
  return result;
}

}  // namespace sweepscope
