#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "core/io/printable_text.hpp"
#include "core/recording/rig.hpp"
#include "core/recording/rig/detect_rig.hpp"

namespace sweepscope {
namespace {

/// A name as YAML has it: plain where it is made of harmless characters, else in double quotes.
std::string yaml_name(const std::string& name) {
  const auto harmless = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; };
  const auto is_null = [&] {
    std::string lower = name;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower == "null";
  };
  const bool begins = !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0;
  if (begins && std::ranges::all_of(name, harmless) && !is_null()) return name;
  return json_string(name);
}

std::string line(const std::string& setting, const std::string& comment) {
  if (comment.empty()) return setting + "\n";
  return fmt::format("{:<34}  # {}\n", setting, printable_line(comment));
}

/// With as many digits as give the same number back, and no exponent's trap: YAML takes 1e-05 as well.
std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string laser_text(const DetectedRig& detected) {
  const Rig::Laser& laser = detected.rig.laser;
  std::string text = "laser:\n";
  if (laser.topic) text += line("  topic: " + yaml_name(*laser.topic), detected.laser_note);
  if (laser.field) text += line("  field: " + yaml_name(*laser.field), "that holds the scan");
  if (laser.echo != Echo::kFirst) text += line("  echo: " + name_of(laser.echo), "first | last | strongest");
  if (laser.stamp) text += line("  stamp: " + name_of(*laser.stamp), "header | receive");
  text += line("  stamp_at: " + name_of(laser.stamp_at),
               "first_beam | last_beam | arrival; " + detected.stamp_at_note);
  if (laser.time_increment_s)
    text += line(fmt::format("  time_increment_s: {}", *laser.time_increment_s), detected.increment_note);
  else
    text += line("  # time_increment_s: 1.736e-5", detected.increment_note);
  return text;
}

std::string profile_text(const MotorProfile& profile) {
  std::string text = line(fmt::format("  profile: {{turns_per_s: {:.9g}", profile.turns_per_s), "");
  if (profile.turns_per_s_within > 0)
    text += fmt::format(", turns_per_s_within: {:.9g}", profile.turns_per_s_within);
  text.pop_back();
  if (profile.between)
    text +=
        fmt::format(", between_deg: [{:.9g}, {:.9g}]", profile.between->from_deg, profile.between->to_deg);
  if (profile.ramp_s > 0) text += fmt::format(", ramp_s: {:.9g}", profile.ramp_s);
  if (profile.steps_per_turn > 0) text += fmt::format(", steps_per_turn: {:.9g}", profile.steps_per_turn);
  if (profile.dwell_s > 0) text += fmt::format(", dwell_s: {:.9g}", profile.dwell_s);
  return text + ", start_s: " + (profile.start_s ? fmt::format("{}", *profile.start_s) : "unknown") + "}\n";
}

std::string index_text(const Rig::Motor& motor) {
  const std::string field = motor.field ? ", field: " + yaml_name(*motor.field) : "";
  return line("  index: {topic: " + yaml_name(motor.topic.value_or("")) + field + "}", "marks each turn");
}

std::string motor_text(const DetectedRig& detected) {
  const Rig::Motor& motor = detected.rig.motor;
  std::string text = "motor:\n";
  const std::string zero = line(fmt::format("  zero_deg: {}", motor.zero_deg), "");
  if (motor.profile) return text + profile_text(*motor.profile) + zero;
  if (motor.index) return text + index_text(motor) + zero;
  if (motor.topic) text += line("  topic: " + yaml_name(*motor.topic), "");
  if (motor.field) text += line("  field: " + yaml_name(*motor.field), "that holds the angle");
  if (motor.joint) text += line("  joint: " + yaml_name(*motor.joint), detected.motor_note);
  if (motor.stamp) text += line("  stamp: " + name_of(*motor.stamp), "header | receive");
  text += line(fmt::format("  scale: {}", motor.scale), "angle = scale * value in `unit`, less zero_deg");
  text += line("  unit: " + name_of(motor.unit), "rad | deg | turns");
  if (!detected.scale_note.empty()) text += "  # " + printable_line(detected.scale_note) + "\n";
  return text + zero;
}

std::string mount_text(const DetectedRig& detected) {
  const Rig::Mount& mount = detected.rig.mount;
  return "mount:  # " + printable_line(detected.mount_note) + "\n" +
         line("  axis: " + vector_text(mount.axis), "the motor's, in the base frame") +
         "  # the laser's pose in the frame that turns with the motor; at motor angle 0 that is the base "
         "frame\n" +
         fmt::format("  laser_in_motor: {{xyz_m: {}, rpy_deg: {}}}\n",
                     vector_text(mount.laser_in_motor_xyz_m), vector_text(mount.laser_in_motor_rpy_deg));
}

std::string noted(const std::string& meaning, const std::string& note) {
  return note.empty() ? meaning : meaning + "; " + note;
}

/// A part that is perfect is not written; why it was not determined is.
std::string gear_text(const DetectedRig& detected) {
  const Rig::Gear& gear = detected.rig.gear;
  std::string text;
  if (gear.play_deg > 0)
    text += line(fmt::format("play_deg: {:.6g}", gear.play_deg),
                 noted("between the flanks of the motor's gear", detected.play_note));
  else if (!detected.play_note.empty())
    text += line("# play_deg: 0", detected.play_note);
  if (gear.encoder_amplitude_deg > 0)
    text += line(fmt::format("encoder: {{amplitude_deg: {:.6g}, phase_deg: {:.6g}}}",
                             gear.encoder_amplitude_deg, gear.encoder_phase_deg),
                 noted("shows the shaft's angle + amplitude sin(angle + phase)", detected.encoder_note));
  else if (!detected.encoder_note.empty())
    text += line("# encoder: {amplitude_deg: 0, phase_deg: 0}", detected.encoder_note);
  return text;
}

/// What is known of a walk's motion: the topics that the rig names, else those seen, as comments.
std::string motion_text(const DetectedRig& detected) {
  const Rig& rig = detected.rig;
  const auto pose = [](const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rpy_deg) {
    return fmt::format("pose_in_base: {{xyz_m: {}, rpy_deg: {}}}", vector_text(xyz_m), vector_text(rpy_deg));
  };
  const std::string imu_pose = pose(rig.imu.pose_in_base_xyz_m, rig.imu.pose_in_base_rpy_deg);
  std::string text;
  if (rig.imu.topic) text += fmt::format("imu:\n  topic: {}\n  {}\n", yaml_name(*rig.imu.topic), imu_pose);
  if (rig.odometry.topic) text += fmt::format("odometry:\n  topic: {}\n", yaml_name(*rig.odometry.topic));
  for (const RecordedTopic& topic : detected.motion_topics) {
    const bool is_imu = topic.type.ends_with("/Imu");
    if (is_imu ? rig.imu.topic.has_value() : rig.odometry.topic.has_value()) continue;
    const std::string setting = fmt::format("# {}: {{topic: {}{}}}", is_imu ? "imu" : "odometry",
                                            yaml_name(topic.name), is_imu ? ", " + imu_pose : "");
    text += line(setting, fmt::format("{} messages; if named here, used as a prior of a moving rig's {}",
                                      topic.messages, is_imu ? "rotation" : "trajectory"));
  }
  return text;
}

}  // namespace

std::string rig_file_text(const DetectedRig& detected) {
  return "# The rig of " + printable_line(detected.recording) +
         ", as detected. Pass it with --rig; deleted keys are detected again.\n" + laser_text(detected) +
         motor_text(detected) + mount_text(detected) + gear_text(detected) + motion_text(detected);
}

}  // namespace sweepscope
