#include "core/recording/rig.hpp"

#include <cmath>
#include <numbers>

#include "core/io/yaml_members.hpp"
#include "core/numbers.hpp"

namespace sweepscope {
namespace {

using yaml::read_choice, yaml::read_members, yaml::read_number, yaml::refuse;

constexpr std::uint64_t kMaxRigFile_bytes = std::uint64_t{1} << 20;

std::string read_name(const YAML::Node& node, const std::string& name) {
  if (!node.IsScalar() || node.Scalar().empty()) refuse(node, fmt::format("{} must be a name", name));
  return node.Scalar();
}

Eigen::Vector3d read_vector(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence() || node.size() != 3) refuse(node, fmt::format("{} must be three numbers", name));
  return {read_number(node[0], name), read_number(node[1], name), read_number(node[2], name)};
}

StampSource read_stamp(const YAML::Node& node, const std::string& name) {
  return read_choice<StampSource>(node, name,
                                  {{"header", StampSource::kHeader}, {"receive", StampSource::kReceive}});
}

void read_laser(const YAML::Node& node, Rig::Laser& laser) {
  read_members(node, "laser",
               {{"topic", [&](const YAML::Node& value) { laser.topic = read_name(value, "laser.topic"); }},
                {"field", [&](const YAML::Node& value) { laser.field = read_name(value, "laser.field"); }},
                {"echo",
                 [&](const YAML::Node& value) {
                   laser.echo = read_choice<Echo>(
                       value, "laser.echo",
                       {{"first", Echo::kFirst}, {"last", Echo::kLast}, {"strongest", Echo::kStrongest}});
                 }},
                {"stamp", [&](const YAML::Node& value) { laser.stamp = read_stamp(value, "laser.stamp"); }},
                {"stamp_at",
                 [&](const YAML::Node& value) {
                   laser.stamp_at = read_choice<StampAt>(value, "laser.stamp_at",
                                                         {{"first_beam", StampAt::kFirstBeam},
                                                          {"last_beam", StampAt::kLastBeam},
                                                          {"arrival", StampAt::kArrival}});
                 }},
                {"time_increment_s", [&](const YAML::Node& value) {
                   const double increment_s = read_number(value, "laser.time_increment_s");
                   if (std::abs(increment_s) >= 1)
                     refuse(value, "laser.time_increment_s must be more than -1 and less than 1 s");
                   laser.time_increment_s = increment_s;
                 }}});
}

double read_positive(const YAML::Node& node, const std::string& name) {
  const double value = read_number(node, name);
  if (!(value > 0)) refuse(node, fmt::format("{} must be more than 0", name));
  return value;
}

MotorProfile::Limits read_limits(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence() || node.size() != 2) refuse(node, fmt::format("{} must be two angles", name));
  const MotorProfile::Limits limits{read_number(node[0], name), read_number(node[1], name)};
  if (std::abs(limits.to_deg - limits.from_deg) < 1)
    refuse(node, fmt::format("{} must be at least 1 deg apart", name));
  return limits;
}

std::optional<double> read_start(const YAML::Node& node, const std::string& name) {
  if (node.IsScalar() && node.Scalar() == "unknown") return std::nullopt;
  return read_number(node, name);
}

MotorProfile read_profile(const YAML::Node& node) {
  MotorProfile profile;
  const std::string name = "motor.profile";
  const auto number = [&](const char* key, double& value) {
    return [&value, full = name + "." + key](const YAML::Node& at) { value = read_positive(at, full); };
  };
  read_members(
      node, name,
      {{"turns_per_s",
        [&](const YAML::Node& value) {
          profile.turns_per_s = read_number(value, name + ".turns_per_s");
          if (profile.turns_per_s == 0 || std::abs(profile.turns_per_s) > 20)
            refuse(value, name + ".turns_per_s must lie between -20 and 20 and not be 0");
        }},
       {"turns_per_s_within", number("turns_per_s_within", profile.turns_per_s_within)},
       {"between_deg",
        [&](const YAML::Node& value) { profile.between = read_limits(value, name + ".between_deg"); }},
       {"ramp_s", number("ramp_s", profile.ramp_s)},
       {"steps_per_turn", number("steps_per_turn", profile.steps_per_turn)},
       {"dwell_s", number("dwell_s", profile.dwell_s)},
       {"start_s",
        [&](const YAML::Node& value) { profile.start_s = read_start(value, name + ".start_s"); }}});
  if (profile.turns_per_s == 0) refuse(node, name + " needs turns_per_s, the mean speed");
  if (profile.between && profile.turns_per_s < 0)
    refuse(node, name + ".turns_per_s is not negative between limits: it begins at the first of them");
  if (profile.turns_per_s_within > 0 && !profile.between)
    refuse(node,
           name + ".turns_per_s_within needs between_deg: the speed is found where the motor turns back");
  if (profile.turns_per_s_within > profile.turns_per_s / 5)
    refuse(node, name + ".turns_per_s_within must be at most a fifth of turns_per_s");
  if (profile.between && profile.ramp_s > profile.sweep_s() / 2)
    refuse(node,
           fmt::format("{}.ramp_s must be at most half of a sweep, {:.3g} s", name, profile.sweep_s() / 2));
  if (profile.dwell_s > 0 && !(profile.steps_per_turn > 0))
    refuse(node, name + ".dwell_s is the rest after a step: it needs steps_per_turn");
  if (profile.steps_per_turn > 0 && profile.ramp_s > 0)
    refuse(node, name + ": ramp_s and steps_per_turn exclude each other");
  const double step_s = 1 / (std::abs(profile.turns_per_s) * profile.steps_per_turn);
  if (profile.dwell_s > step_s)
    refuse(node, fmt::format("{}.dwell_s is longer than a step with its rest, {:.3g} s", name, step_s));
  return profile;
}

void read_index(const YAML::Node& node, Rig::Motor& motor) {
  motor.index = true;
  read_members(
      node, "motor.index",
      {{"topic", [&](const YAML::Node& value) { motor.topic = read_name(value, "motor.index.topic"); }},
       {"field", [&](const YAML::Node& value) { motor.field = read_name(value, "motor.index.field"); }}});
  if (!motor.topic) refuse(node, "motor.index needs topic");
}

void read_motor(const YAML::Node& node, Rig::Motor& motor) {
  read_members(
      node, "motor",
      {{"topic", [&](const YAML::Node& value) { motor.topic = read_name(value, "motor.topic"); }},
       {"field", [&](const YAML::Node& value) { motor.field = read_name(value, "motor.field"); }},
       {"joint", [&](const YAML::Node& value) { motor.joint = read_name(value, "motor.joint"); }},
       {"stamp", [&](const YAML::Node& value) { motor.stamp = read_stamp(value, "motor.stamp"); }},
       {"scale",
        [&](const YAML::Node& value) {
          motor.scale = read_number(value, "motor.scale");
          if (motor.scale == 0) refuse(value, "motor.scale must not be 0");
        }},
       {"unit",
        [&](const YAML::Node& value) {
          motor.unit = read_choice<AngleUnit>(
              value, "motor.unit",
              {{"rad", AngleUnit::kRad}, {"deg", AngleUnit::kDeg}, {"turns", AngleUnit::kTurns}});
        }},
       {"zero_deg", [&](const YAML::Node& value) { motor.zero_deg = read_number(value, "motor.zero_deg"); }},
       {"index", [&](const YAML::Node& value) { read_index(value, motor); }},
       {"profile", [&](const YAML::Node& value) { motor.profile = read_profile(value); }}});
  if (motor.profile && (motor.topic || motor.joint || motor.field))
    refuse(node,
           "motor.profile stands for a motor without messages: leave out topic, joint, field and index");
}

/// `laser_in_motor` and `pose_in_base`.
void read_pose(const YAML::Node& node, const std::string& name, Eigen::Vector3d& xyz_m,
               Eigen::Vector3d& rpy_deg) {
  read_members(
      node, name,
      {{"xyz_m", [&](const YAML::Node& value) { xyz_m = read_vector(value, name + ".xyz_m"); }},
       {"rpy_deg", [&](const YAML::Node& value) { rpy_deg = read_vector(value, name + ".rpy_deg"); }}});
}

void read_mount(const YAML::Node& node, Rig::Mount& mount) {
  const auto read_laser_pose = [&](const YAML::Node& pose) {
    read_pose(pose, "mount.laser_in_motor", mount.laser_in_motor_xyz_m, mount.laser_in_motor_rpy_deg);
  };
  const auto read_axis = [&](const YAML::Node& value) {
    mount.axis = read_vector(value, "mount.axis");
    const double length = mount.axis.norm();
    if (!(length > 1e-6) || !std::isfinite(length)) refuse(value, "mount.axis must have a direction");
    mount.axis /= length;
  };
  read_members(node, "mount", {{"axis", read_axis}, {"laser_in_motor", read_laser_pose}});
}

void read_gear(const YAML::Node& value, const std::string& name, double& at_least_0) {
  at_least_0 = read_number(value, name);
  if (at_least_0 < 0 || at_least_0 > 10) refuse(value, name + " must be from 0 to 10");
}

void read_encoder(const YAML::Node& node, Rig::Gear& gear) {
  read_members(node, "encoder",
               {{"amplitude_deg",
                 [&](const YAML::Node& value) {
                   read_gear(value, "encoder.amplitude_deg", gear.encoder_amplitude_deg);
                 }},
                {"phase_deg", [&](const YAML::Node& value) {
                   gear.encoder_phase_deg = read_number(value, "encoder.phase_deg");
                 }}});
}

void read_imu(const YAML::Node& node, Rig::Imu& imu) {
  read_members(node, "imu",
               {{"topic", [&](const YAML::Node& value) { imu.topic = read_name(value, "imu.topic"); }},
                {"pose_in_base", [&](const YAML::Node& value) {
                   read_pose(value, "imu.pose_in_base", imu.pose_in_base_xyz_m, imu.pose_in_base_rpy_deg);
                 }}});
}

void read_odometry(const YAML::Node& node, Rig::Odometry& odometry) {
  read_members(
      node, "odometry",
      {{"topic", [&](const YAML::Node& value) { odometry.topic = read_name(value, "odometry.topic"); }}});
}

Rig read_document(const YAML::Node& document) {
  Rig rig;
  read_members(document, "the rig file",
               {{"laser", [&](const YAML::Node& node) { read_laser(node, rig.laser); }},
                {"motor", [&](const YAML::Node& node) { read_motor(node, rig.motor); }},
                {"mount",
                 [&](const YAML::Node& node) {
                   read_mount(node, rig.mount);
                   rig.mount_in_file = true;
                 }},
                {"play_deg", [&](const YAML::Node& node) { read_gear(node, "play_deg", rig.gear.play_deg); }},
                {"encoder", [&](const YAML::Node& node) { read_encoder(node, rig.gear); }},
                {"imu", [&](const YAML::Node& node) { read_imu(node, rig.imu); }},
                {"odometry", [&](const YAML::Node& node) { read_odometry(node, rig.odometry); }}});
  return rig;
}

}  // namespace

double Rig::Motor::rad_per_value() const {
  if (unit == AngleUnit::kRad) return scale;
  return scale * (unit == AngleUnit::kDeg ? kRadPerDeg : 2 * std::numbers::pi);
}

bool Rig::states_mount() const {
  const Mount none;
  return mount_in_file || mount.axis != none.axis ||
         mount.laser_in_motor_xyz_m != none.laser_in_motor_xyz_m ||
         mount.laser_in_motor_rpy_deg != none.laser_in_motor_rpy_deg;
}

Gear Rig::Gear::angles() const {
  const double amplitude_rad = encoder_amplitude_deg * kRadPerDeg, phase_rad = encoder_phase_deg * kRadPerDeg;
  return {play_deg * kRadPerDeg, {amplitude_rad * std::cos(phase_rad), amplitude_rad * std::sin(phase_rad)}};
}

Result<Rig> read_rig(const std::filesystem::path& path) {
  Rig rig;
  return yaml::read_file(path, "a rig file", kMaxRigFile_bytes,
                         [&](const YAML::Node& node) { rig = read_document(node); })
      .map([&] { return std::move(rig); });
}

}  // namespace sweepscope
