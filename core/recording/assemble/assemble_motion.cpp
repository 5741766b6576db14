#include "core/recording/assemble/assemble.hpp"

#include <fmt/format.h>

#include "core/geometry/pose.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

/// The usable samples of a topic in the order of time.
struct Samples {
  std::vector<std::size_t> number;
  std::vector<double> time_s;
};

template <typename Usable>
Samples in_order(const std::vector<MessageStamps>& stamps, const Recording& recording, const Usable& usable) {
  Samples all, kept;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const std::int64_t ns = stamp_ns(stamps[i], recording.report.laser_stamps.used);
    if (ns == 0 || !usable(i)) continue;
    all.number.push_back(i);
    all.time_s.push_back(static_cast<double>(ns - recording.epoch_ns) * 1e-9);
  }
  for (const std::size_t i : order_by_time(all.time_s).kept) {
    kept.number.push_back(all.number[i]);
    kept.time_s.push_back(all.time_s[i]);
  }
  return kept;
}

void warn(const std::string& topic, const char* type, const char* key, std::size_t messages, std::size_t used,
          std::vector<std::string>& warnings) {
  if (used < 2)
    warnings.push_back(fmt::format("{}, the rig's {}.topic, has {} usable messages of {}: it is not used",
                                   topic, key, used, type));
  else if (used < messages)
    warnings.push_back(
        fmt::format("{} of {} messages on {} were dropped: no stamp, no finite number, or a duplicate time",
                    messages - used, messages, topic));
}

}  // namespace

void assemble_motion(const RawRecording& raw, Recording& recording) {
  const Rig& rig = recording.rig;
  std::vector<std::string>& warnings = recording.report.warnings;
  if (rig.imu.topic) {
    const Eigen::Quaterniond base_from_imu = rotation_from_rpy(rig.imu.pose_in_base_rpy_deg);
    const auto& rates_rad_s = raw.turn_rates.rates_rad_s;
    Samples samples =
        in_order(raw.turn_rates.stamps, recording, [&](std::size_t i) { return rates_rad_s[i].allFinite(); });
    warn(*rig.imu.topic, "sensor_msgs/Imu", "imu", rates_rad_s.size(), samples.number.size(), warnings);
    for (const std::size_t i : samples.number)
      recording.turn_rates.rate_rad_s.emplace_back(base_from_imu * rates_rad_s[i]);
    recording.turn_rates.time_s = std::move(samples.time_s);
  }
  if (rig.odometry.topic) {
    const RawOdometry& odometry = raw.odometry;
    const auto usable = [&](std::size_t i) {
      const double length = odometry.orientations[i].norm();
      return odometry.positions_m[i].allFinite() && length > 0.5 && length < 2;
    };
    const Samples samples = in_order(odometry.stamps, recording, usable);
    warn(*rig.odometry.topic, "nav_msgs/Odometry", "odometry", odometry.stamps.size(), samples.number.size(),
         warnings);
    for (std::size_t k = 0; k < samples.number.size(); ++k) {
      const std::size_t i = samples.number[k];
      recording.odometry.push_back(
          {samples.time_s[k], odometry.positions_m[i], odometry.orientations[i].normalized()});
    }
  }
}

}  // namespace sweepscope
