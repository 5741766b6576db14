#include "core/simulation/write_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/io/atomic_file.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "core/recording/rig/detect_rig.hpp"
#include "core/simulation/math/portable_math.hpp"

namespace sweepscope {
namespace {

using simulation::Random;

/// Turns the order of the beams of a scan round.
void reverse(const RawScan& scan, std::vector<float>& of_beams) {
  const auto first = of_beams.begin() + static_cast<std::ptrdiff_t>(scan.first_range);
  std::reverse(first, first + scan.beams);
}

/// What a driver writes of a scan.
RawScan raw_scan(const Simulation& simulation, std::size_t number) {
  const SimulationOptions& options = simulation.options;
  const Recording& recording = simulation.recording;
  const LaserScan& scan = recording.scans[number];
  const double known_s = scan.last_beam_s() + kScanLatency_s;
  const bool first = options.stamp_at == StampAt::kFirstBeam;
  const bool reversed = fired_times(options) == simulation::BeamTimes::kReversed;
  RawScan raw;
  raw.stamps = {in_ns(recording, first ? scan.first_beam_s : scan.last_beam_s()),
                in_ns(recording, known_s + delay_s(simulation, Arrival::kScan, number))};
  raw.first_range = scan.first_range;
  raw.beams = scan.beams;
  raw.angle_min_rad =
      static_cast<float>(reversed ? scan.beam_angle_rad(scan.beams - 1.0) : scan.angle_min_rad);
  raw.angle_increment_rad =
      static_cast<float>(reversed ? -scan.angle_increment_rad : scan.angle_increment_rad);
  raw.angle_max_rad =
      static_cast<float>(double{raw.angle_min_rad} + (scan.beams - 1.0) * double{raw.angle_increment_rad});
  raw.time_increment_s = static_cast<float>(options.no_time_increment ? 0 : scan.time_increment_s);
  raw.scan_time_s = static_cast<float>(options.scanner.scan_period_s * options.scan_time_factor);
  raw.range_min_m = static_cast<float>(options.scanner.range_min_m);
  raw.range_max_m = static_cast<float>(options.scanner.range_max_m);
  return raw;
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
    laser.scans.push_back(raw_scan(simulation, i));
    if (fired_times(simulation.options) != simulation::BeamTimes::kReversed) continue;
    reverse(laser.scans.back(), laser.ranges_m);
    reverse(laser.scans.back(), laser.intensities);
  }
  return laser;
}

/// A message each time that the encoder passes a whole turn.
RawJoint raw_index(const Simulation& simulation) {
  const MotorTrack& motor = simulation.recording.motor;
  RawJoint joint;
  joint.topic = "/index";
  joint.joint = "data";
  joint.source = JointSource::kNumber;
  const auto turn = [&](std::size_t i) { return std::floor(simulation::degrees(motor.angle_rad[i]) / 360); };
  for (std::size_t i = 1; i < motor.time_s.size(); ++i) {
    if (turn(i) == turn(i - 1)) continue;
    const double from_deg = simulation::degrees(motor.angle_rad[i - 1]),
                 to_deg = simulation::degrees(motor.angle_rad[i]);
    const double at_deg = 360 * std::max(turn(i), turn(i - 1));
    const double stamp_s = motor.time_s[i - 1] + (motor.time_s[i] - motor.time_s[i - 1]) *
                                                     (at_deg - from_deg) / (to_deg - from_deg);
    joint.positions.push_back(1);
    joint.stamps.push_back({0, in_ns(simulation.recording, stamp_s + kMotorLatency_s)});
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
  const simulation::Scanner& scanner = simulation.options.scanner;
  const LaserScan& scan = simulation.recording.scans.front();
  const double turn_s =
      scanner.is_3d() ? scanner.beams * scanner.increment_s() : scan.last_beam_s() - scan.first_beam_s;
  const double scan_s = turn_s + kScanLatency_s;
  return std::max(0.0, simulation.options.offset_s) + kMotorLatency_s - scan_s;
}

Json options_json(const SimulationOptions& o) {
  Json speeds = Json::array();
  for (const double speed_dps : o.speeds_dps) speeds.push_back(tidy(speed_dps));
  return {{"seed", o.seed},
          {"duration_s", tidy(*o.duration_s)},
          {"noise_mm", tidy(o.noise_m.value_or(o.scanner.noise_m) * 1e3)},
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

/// The scanner, the motor's axis and swing, and how the drivers write.
Json recorded_as_json(const SimulationOptions& o) {
  return {{"scanner", o.scanner.name},
          {"beam_times", name_of(fired_times(o))},
          {"stamp_at", name_of(o.stamp_at)},
          {"no_time_increment", o.no_time_increment},
          {"scan_time_factor", tidy(o.scan_time_factor)},
          {"parts", o.parts},
          {"axis", name_of(o.axis)},
          {"swing_deg", tidy(o.swing_deg)},
          {"steps_per_turn", tidy(o.steps_per_turn)},
          {"dwell_s", tidy(o.dwell_s)},
          {"motor_rest_s", tidy(o.motor_rest_s)},
          {"motor_rest_at_s", tidy(o.motor_rest_at_s)},
          {"laser_upside_down", o.laser_upside_down},
          {"motor_repeats", o.motor_repeats},
          {"motor_in_degrees", o.motor_in_degrees},
          {"motor_messages", name_of(o.motor_messages)}};
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

/// Whether the messages are read wrongly, or not with certainty, without a rig file.
bool needs_rig_file(const SimulationOptions& options) {
  const Rig rig = rig_of(options), plain;
  return rig.motor.profile || rig.motor.index || rig.laser.time_increment_s ||
         rig.laser.stamp_at != plain.laser.stamp_at || rig.motor.scale != plain.motor.scale ||
         rig.mount.axis != plain.mount.axis ||
         rig.mount.laser_in_motor_rpy_deg != plain.mount.laser_in_motor_rpy_deg;
}

std::string rig_text(const Simulation& simulation, const std::filesystem::path& bag_path) {
  DetectedRig rig;
  rig.rig = rig_of(simulation.options);
  rig.recording = bag_path.filename().string();
  rig.stamp_at_note = rig.mount_note = "as simulated";
  rig.increment_note = "0: all beams at once; negative: the last beam of the array is fired first";
  return rig_file_text(rig);
}

std::filesystem::path stem_of(std::filesystem::path bag_path) {
  return bag_path.extension() == ".bag" ? bag_path.replace_extension() : bag_path;
}

}  // namespace

std::int64_t in_ns(const Recording& recording, double time_s) {
  return recording.epoch_ns + static_cast<std::int64_t>(std::floor(time_s * 1e9 + 0.5));
}

RawJoint raw_joint(const Simulation& simulation) {
  const SimulationOptions& options = simulation.options;
  if (options.motor_messages == MotorMessages::kIndex) return raw_index(simulation);
  const std::vector<double>& times_s = simulation.recording.motor.time_s;
  RawJoint joint;
  joint.topic = "/joint_states";
  joint.joint = "roll_motor";
  if (options.motor_messages == MotorMessages::kNone) return joint;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double angle_rad = simulation.recording.motor.angle_rad[i];
    for (std::uint32_t repeat = 0; repeat < options.motor_repeats; ++repeat) {
      // The last one is repeated as quickly as the one before it.
      const std::size_t from = std::min(i, times_s.size() - 2);
      const double since_s = repeat * (times_s[from + 1] - times_s[from]) / options.motor_repeats;
      const double stamp_s = repeat == 0 ? times_s[i] : times_s[i] + since_s;
      // Where the motor's clock is behind the laser's, its stamp is older than the instant it is about.
      const double known_s = stamp_s + std::max(0.0, -options.offset_s) + kMotorLatency_s;
      const std::size_t number = i * options.motor_repeats + repeat;
      joint.positions.push_back(options.motor_in_degrees ? simulation::degrees(angle_rad) : angle_rad);
      joint.stamps.push_back(
          {in_ns(simulation.recording, stamp_s),
           in_ns(simulation.recording, known_s + delay_s(simulation, Arrival::kMotor, number))});
    }
  }
  return joint;
}

Result<void> write_bag(const Simulation& simulation, const std::filesystem::path& path, const Job& job) {
  const auto messages = simulation.messages ? simulation.messages
                                            : std::make_shared<const RawRecording>(messages_of(simulation));
  return write_recording(messages->lasers.front(), messages->joints.front(), RecordingFormat::kRos1, "none",
                         path, job, raw_imu(simulation));
}

double delay_s(const Simulation& simulation, Arrival what, std::size_t number) {
  constexpr double kMean_s = 0.0003, kMax_s = 0.003;
  const double u = Random(simulation.options.seed, std::uint64_t(what), number).uniform();
  return std::min(-kMean_s * simulation::natural_log(1 - u), kMax_s);
}

RawRecording messages_of(const Simulation& simulation) {
  if (simulation.messages) return *simulation.messages;
  RawRecording raw;
  raw.file = raw.name = simulation.recording.name;
  raw.lasers.push_back(raw_laser(simulation));
  raw.joints.push_back(raw_joint(simulation));
  return raw;
}

std::vector<std::filesystem::path> files_of_simulation(const SimulationOptions& options,
                                                       const std::filesystem::path& bag_path) {
  std::vector<std::filesystem::path> files{bag_path, truth_json_path(bag_path), truth_tum_path(bag_path)};
  if (needs_rig_file(options)) files.push_back(rig_path(bag_path));
  return files;
}

std::filesystem::path rig_path(const std::filesystem::path& bag_path) {
  return stem_of(bag_path).string() + ".rig.yaml";
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
                 {"rpy_deg", triple(laser_in_motor_rpy_deg(simulation.options))}}},
               {"options", options_json(simulation.options)},
               {"version", SWEEPSCOPE_VERSION}};
  const Json recorded_as = recorded_as_json(simulation.options);
  if (recorded_as != recorded_as_json({})) json["recorded_as"] = recorded_as;
  if (!simulation.options.own.mesh.empty()) json["own_scene"] = own_json(simulation);
  if (const RandomWorld& random = simulation.options.random; !random.world.empty())
    json["random_world"] = {{"world", random.world},
                            {"world_seed", random.world_seed},
                            {"walk", random.walk},
                            {"walk_seed", random.walk_seed}};
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
  const auto written = write_file(truth_json_path(bag_path), truth_json(simulation)).and_then([&] {
    return write_file(truth_tum_path(bag_path), truth_tum(simulation));
  });
  if (!written || !needs_rig_file(simulation.options)) return written;
  return write_file(rig_path(bag_path), rig_text(simulation, bag_path));
}

}  // namespace sweepscope
