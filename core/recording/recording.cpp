#include "core/recording/recording.hpp"

namespace sweepscope {

Recording window(const Recording& recording, double from_s, double to_s) {
  Recording part;
  part.name = recording.name;
  part.epoch_ns = recording.epoch_ns;
  part.rig = recording.rig;
  part.report = recording.report;
  part.turn_rates = recording.turn_rates;
  part.odometry = recording.odometry;
  if (recording.scans.empty()) return part;
  const double start_s = recording.scans.front().first_beam_s;
  for (LaserScan scan : recording.scans) {
    const double since_s = scan.first_beam_s - start_s;
    if (since_s < from_s || since_s > to_s) continue;
    const std::size_t source = scan.first_range;
    scan.first_range = part.ranges_m.size();
    const auto copy = [&](const auto& from, auto& to) {
      to.insert(to.end(), from.begin() + std::ptrdiff_t(source),
                from.begin() + std::ptrdiff_t(source + scan.beams));
    };
    copy(recording.ranges_m, part.ranges_m);
    if (!recording.intensities.empty()) copy(recording.intensities, part.intensities);
    if (!recording.directions.empty()) copy(recording.directions, part.directions);
    part.scans.push_back(scan);
  }
  if (part.scans.empty()) return part;
  constexpr double kMargin_s = 1.0;
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i) {
    const double t_s = recording.motor.time_s[i];
    if (t_s < part.scans.front().first_beam_s - kMargin_s ||
        t_s > part.scans.back().last_beam_s() + kMargin_s)
      continue;
    part.motor.time_s.push_back(t_s);
    part.motor.angle_rad.push_back(recording.motor.angle_rad[i]);
  }
  return part;
}

}  // namespace sweepscope
