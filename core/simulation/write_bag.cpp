#include "core/simulation/write_bag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/recording/write_ros1_bag.hpp"
#include "core/simulation/portable_math.hpp"
#include "core/simulation/sensor.hpp"

namespace sweepscope {
namespace {

using simulation::Random;
using simulation::Sensor;

enum Purpose : std::uint64_t { kScanArrival = 101, kMotorArrival = 102 };

/// Most messages arrive promptly, few late: an exponential distribution, cut off.
double delay_s(const Simulation& simulation, Purpose purpose, std::size_t number) {
  constexpr double kMean_s = 0.0003, kMost_s = 0.003;
  const double u = Random(simulation.options.seed, purpose, number).uniform();
  return std::min(-kMean_s * simulation::natural_log(1 - u), kMost_s);
}

std::int64_t in_ns(const Recording& recording, double time_s) {
  return recording.epoch_ns + static_cast<std::int64_t>(std::floor(time_s * 1e9 + 0.5));
}

RawLaser raw_laser(const Simulation& simulation) {
  const Recording& recording = simulation.recording;
  RawLaser laser;
  laser.topic = "/scan";
  laser.ranges_m = recording.ranges_m;
  for (float& range_m : laser.ranges_m)
    if (std::isnan(range_m)) range_m = std::numeric_limits<float>::infinity();
  laser.intensities = recording.intensities;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    const double known_s = scan.last_beam_s() + kScanLatency_s;
    RawScan raw;
    raw.stamps = {in_ns(recording, scan.first_beam_s),
                  in_ns(recording, known_s + delay_s(simulation, kScanArrival, i))};
    raw.angle_min_rad = static_cast<float>(scan.angle_min_rad);
    raw.angle_max_rad = static_cast<float>(scan.beam_angle_rad(scan.beams - 1.0));
    raw.angle_increment_rad = static_cast<float>(scan.angle_increment_rad);
    raw.time_increment_s = static_cast<float>(scan.time_increment_s);
    raw.scan_time_s = static_cast<float>(Sensor::kScanPeriod_s);
    raw.range_min_m = static_cast<float>(Sensor::kRangeMin_m);
    raw.range_max_m = static_cast<float>(Sensor::kRangeMax_m);
    raw.first_range = scan.first_range;
    raw.beams = scan.beams;
    laser.scans.push_back(raw);
  }
  return laser;
}

RawJoint raw_joint(const Simulation& simulation) {
  const Recording& recording = simulation.recording;
  RawJoint joint;
  joint.topic = "/joint_states";
  joint.joint = "roll_motor";
  joint.positions = recording.motor.angle_rad;
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i) {
    // Where the motor's clock is behind the laser's, its stamp is older than the instant it is about.
    const double known_s =
        recording.motor.time_s[i] + std::max(0.0, -simulation.options.offset_s) + kMotorLatency_s;
    joint.stamps.push_back({in_ns(recording, recording.motor.time_s[i]),
                            in_ns(recording, known_s + delay_s(simulation, kMotorArrival, i))});
  }
  return joint;
}

std::optional<RawImu> raw_imu(const Simulation& simulation) {
  if (!simulation.options.imu) return std::nullopt;
  RawImu imu{"/imu", {}};
  imu.rates.rates_rad_s = simulation.imu.rate_rad_s;
  for (const double time_s : simulation.imu.time_s) {
    const double known_s = time_s + simulation.options.imu_shift_s + kMotorLatency_s;
    imu.rates.stamps.push_back({in_ns(simulation.recording, time_s), in_ns(simulation.recording, known_s)});
  }
  return imu;
}

}  // namespace

Result<void> write_bag(const Simulation& simulation, const std::filesystem::path& path, const Job& job) {
  return write_ros1_bag(raw_laser(simulation), raw_joint(simulation), path, "none", job, raw_imu(simulation));
}

}  // namespace sweepscope
