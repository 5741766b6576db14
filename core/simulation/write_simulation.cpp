#include "core/simulation/write_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/io/atomic_file.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/sensor.hpp"

namespace sweepscope {
namespace {

using simulation::Random;
using simulation::Sensor;

enum ArrivalPurpose : std::uint64_t { kScanArrival = 101, kMotorArrival = 102 };

/// Most messages arrive promptly, few late: an exponential distribution, cut off.
double delay_s(const Simulation& simulation, ArrivalPurpose purpose, std::size_t number) {
  constexpr double kMean_s = 0.0003, kMax_s = 0.003;
  const double u = Random(simulation.options.seed, purpose, number).uniform();
  return std::min(-kMean_s * simulation::natural_log(1 - u), kMax_s);
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

using Json = nlohmann::ordered_json;

/// Six digits after the point: free of binary tails such as 24.000000000000004.
double tidy(double value) {
  return std::round(value * 1e6) / 1e6;
}

Json triple(const Eigen::Vector3d& v) {
  return {tidy(v.x()), tidy(v.y()), tidy(v.z())};
}

/// The offset between the two streams' receive times: what an estimate on receive stamps finds.
double receive_offset_s(const Simulation& simulation) {
  const LaserScan& scan = simulation.recording.scans.front();
  const double scan_s = scan.last_beam_s() - scan.first_beam_s + kScanLatency_s;
  return std::max(0.0, simulation.options.offset_s) + kMotorLatency_s - scan_s;
}

Json options_json(const SimulationOptions& o) {
  Json speeds = Json::array();
  for (const double speed_dps : o.speeds_dps) speeds.push_back(tidy(speed_dps));
  return {{"seed", o.seed},
          {"duration_s", tidy(*o.duration_s)},
          {"noise_mm", tidy(o.noise_m * 1e3)},
          {"dropout", tidy(o.dropout)},
          {"sweep_s", tidy(o.sweep_s)},
          {"motor", simulation::name_of(o.motor)},
          {"motor_middle_deg", tidy(o.motor_middle_deg)},
          {"speeds_dps", speeds},
          {"speed_ramp", o.speed_ramp},
          {"encoder_step_deg", tidy(o.encoder_step_deg)},
          {"encoder_hz", tidy(o.encoder_hz)},
          {"encoder_jitter_ms", tidy(o.encoder_jitter_s * 1e3)},
          {"mixed_pixels", tidy(o.mixed_pixels)},
          {"grazing_bias_mm", tidy(o.grazing_bias_m * 1e3)},
          {"stamp_jitter_ms", tidy(o.stamp_jitter_s * 1e3)},
          {"backlash_deg", tidy(o.backlash_deg)},
          {"clock_drift_ppm", tidy(o.clock_drift_ppm)},
          {"jump_ms", tidy(o.jump_s * 1e3)},
          {"jump_at_s", tidy(o.jump_at_s)},
          {"nudge_mm", tidy(o.nudge_m * 1e3)},
          {"noise_per_m_mm", tidy(o.noise_per_m * 1e3)},
          {"grazing_dropout", tidy(o.grazing_dropout)},
          {"mount_error_deg", triple(o.mount_error_deg)},
          {"mount_error_mm", triple(o.mount_error_m * 1e3)},
          {"eccentricity_deg", tidy(o.eccentricity_deg)},
          {"eccentricity_phase_deg", tidy(o.eccentricity_phase_deg)},
          {"uneven_motor", tidy(o.uneven_motor)},
          {"people", o.people},
          {"glass", tidy(o.glass)}};
}

/// The files that an own scene is made of, and how far its motion is from the recorded one.
Json own_json(const Simulation& simulation) {
  const OwnScene& own = simulation.options.own;
  const simulation::PathPlacement& placement = own.placement;
  Json json = {{"mesh", own.mesh.filename().string()}, {"mesh_hash", simulation.mesh_hash}};
  json["at_m"] = placement.at_m ? triple(*placement.at_m) : Json(nullptr);
  json["yaw_deg"] = tidy(placement.yaw_deg);
  if (own.trajectory.empty()) return json;
  json["trajectory"] = own.trajectory.filename().string();
  json["trajectory_hash"] = simulation.trajectory_hash;
  json["scale"] = tidy(placement.scale);
  json["upright"] = placement.upright;
  json["from_s"] = tidy(own.from_s);
  json["smoothing_ms"] = tidy(placement.smoothing_s * 1e3);
  json["spline_rms_mm"] = tidy(simulation.deviation.position_m * 1e3);
  json["spline_rms_deg"] = tidy(simulation::degrees(simulation.deviation.rotation_rad));
  return json;
}

std::filesystem::path stem_of(std::filesystem::path bag_path) {
  return bag_path.extension() == ".bag" ? bag_path.replace_extension() : bag_path;
}

}  // namespace

Result<void> write_bag(const Simulation& simulation, const std::filesystem::path& path, const Job& job) {
  return write_recording(raw_laser(simulation), raw_joint(simulation), RecordingFormat::kRos1, "none", path,
                         job, raw_imu(simulation));
}

std::filesystem::path truth_json_path(const std::filesystem::path& bag_path) {
  return stem_of(bag_path).string() + ".truth.json";
}

std::filesystem::path truth_tum_path(const std::filesystem::path& bag_path) {
  return stem_of(bag_path).string() + ".truth.tum";
}

std::string truth_json(const Simulation& simulation) {
  const Recording& recording = simulation.recording;
  Json json = {{"schema", "sweepscope.truth/1"},
               {"scene", simulation.options.scene},
               {"equation", "t_motor = t_laser + offset"},
               {"offset_ms", tidy(simulation.options.offset_s * 1e3)},
               {"receive_offset_ms", tidy(receive_offset_s(simulation) * 1e3)},
               {"moving", simulation.moving},
               {"length_m", tidy(simulation.length_m)},
               {"top_speed_mps", tidy(simulation.top_speed_mps)},
               {"top_angular_rate_radps", tidy(simulation.top_angular_rate_radps)},
               {"scans", recording.scans.size()},
               {"motor_samples", recording.motor.time_s.size()},
               {"triangles", simulation.triangles},
               {"laser_in_motor",
                {{"xyz_m", triple(simulation.options.mount_error_m)},
                 {"rpy_deg", triple(simulation.options.mount_error_deg)}}},
               {"options", options_json(simulation.options)},
               {"version", SWEEPSCOPE_VERSION}};
  if (!simulation.options.own.mesh.empty()) json["own_scene"] = own_json(simulation);
  if (simulation.options.imu)
    json["imu"] = {{"topic", "/imu"}, {"time_shift_ms", tidy(simulation.options.imu_shift_s * 1e3)}};
  return json.dump(2) + "\n";
}

std::string truth_tum(const Simulation& simulation) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const TruthPose& pose : simulation.truth) {
    const std::int64_t ns = simulation.recording.epoch_ns + std::llround(pose.time_s * 1e9);
    const Eigen::Vector3d& p = pose.position_m;
    const Eigen::Quaterniond& q = pose.orientation;
    text += fmt::format("{}.{:09} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", ns / 1'000'000'000,
                        ns % 1'000'000'000, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

Result<void> write_truth(const Simulation& simulation, const std::filesystem::path& bag_path) {
  return write_file(truth_json_path(bag_path), truth_json(simulation)).and_then([&] {
    return write_file(truth_tum_path(bag_path), truth_tum(simulation));
  });
}

}  // namespace sweepscope
