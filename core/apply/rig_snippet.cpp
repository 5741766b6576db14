#include "core/apply/rig_snippet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/apply/driver_parameters.hpp"
#include "core/geometry/pose.hpp"
#include "core/io/printable_text.hpp"

namespace sweepscope {
namespace {

/// Without the minus sign of a zero.
std::string number(double value) {
  const std::string text = fmt::format("{:.9f}", value);
  return text == "-0.000000000" ? text.substr(1) : text;
}

std::string numbers(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", number(v.x()), number(v.y()), number(v.z()));
}

/// In a comment of XML two hyphens must not follow each other.
std::string commented(std::string text) {
  for (auto at = text.find("--"); at != text.npos; at = text.find("--", at)) text.replace(at, 2, "- -");
  return text;
}

std::string xml_comment(const std::vector<std::string>& lines) {
  std::string text = "<!--\n";
  for (const std::string& line : lines) text += "  " + commented(line) + "\n";
  return text + "  (Two hyphens are written apart here, as comments of XML require.)\n-->\n";
}

std::string line_comment(const std::vector<std::string>& lines, std::string_view mark) {
  std::string text;
  for (const std::string& line : lines) text += fmt::format("{} {}\n", mark, line);
  return text;
}

/// The joint as a robot model writes it: base_from_motor = R(origin) Rot(axis, position), for a position in
/// rad as the recording has it. sweepscope's is Rot(axis, scale position - zero).
struct Joint {
  Eigen::Vector3d axis, origin_rpy_rad;
};

Joint joint_of(const Rig& rig) {
  const Eigen::Vector3d axis = rig.mount.axis.normalized();
  const Eigen::AngleAxisd to_zero(-rig.motor.zero_deg * kRadPerDeg, axis);
  return {rig.motor.scale < 0 ? Eigen::Vector3d(-axis) : axis, rpy_rad_of(Eigen::Quaterniond(to_zero))};
}

Eigen::Vector3d mount_rpy_rad(const Rig& rig) {
  return rpy_rad_of(rotation_from_rpy(rig.mount.laser_in_motor_rpy_deg));
}

std::string joint_name(const Rig& rig) {
  return rig.motor.joint.value_or("motor_joint");
}

/// What every snippet says.
std::vector<std::string> head(const RigSnippet& snippet) {
  std::vector<std::string> lines{
      "Written by sweepscope " SWEEPSCOPE_VERSION " from " + printable_line(snippet.source),
      fmt::format("t_motor = t_laser + offset, offset {} s", number(snippet.offset.offset_s))};
  if (snippet.offset.changes())
    lines.emplace_back(
        "The offset changes over time; this is one value of it. sweepscope apply applies all of it.");
  return lines;
}

/// What a robot model cannot hold.
std::vector<std::string> missing_parts(const Rig& rig) {
  std::vector<std::string> lines;
  const double unit = std::abs(rig.motor.rad_per_value());
  if (unit != 1)
    lines.push_back(fmt::format(
        "The joint's positions must be in rad: multiply those of the recording by {}.", number(unit)));
  if (!rig.gear.angles().perfect())
    lines.emplace_back(
        "Gear play and the encoder's eccentricity cannot be set here: sweepscope apply --tf --rig writes "
        "transforms with them.");
  return lines;
}

/// For systems that take the motor's angle from transforms.
std::vector<std::string> offset_by_transforms(const RigSnippet& snippet) {
  const double offset_s = snippet.offset.offset_s;
  return {
      "The offset cannot be set here. Transforms of the motor have its stamps, which must be moved onto the",
      fmt::format("laser's clock: {} {} s {} each stamp of the joint, or, for a recording:",
                  offset_s < 0 ? "add" : "subtract", number(std::abs(offset_s)),
                  offset_s < 0 ? "to" : "from"),
      fmt::format("  sweepscope apply REC -o OUT --offset-ms {:.6f}", offset_s * 1e3)};
}

/// Where the turning frame comes from.
std::vector<std::string> turning_frame(const RigSnippet& snippet) {
  return {fmt::format("{} in {} turns with the motor: robot_state_publisher (sweepscope rig --as urdf).",
                      printable_line(snippet.motor_frame), printable_line(snippet.base_frame)),
          "A recording of sweepscope apply --tf holds the laser's pose in the base frame; leave the mount "
          "out then."};
}

std::vector<std::string> joined(std::vector<std::string> lines, const std::vector<std::string>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
  return lines;
}

constexpr const char* kUrdfSource =
    "Notation: http://wiki.ros.org/urdf/XML/joint (origin: xyz in m, rpy in rad about fixed axes; axis in "
    "the "
    "joint frame)";

/// The two joints; with a prefix of names for a macro of xacro.
std::string joints(const RigSnippet& snippet, const std::string& prefix, const std::string& parent) {
  const Joint motor = joint_of(snippet.rig);
  const std::string motor_link = prefix + markup_line(snippet.motor_frame),
                    laser_link = prefix + markup_line(snippet.laser_frame);
  return fmt::format("  <link name=\"{0}\"/>\n  <link name=\"{1}\"/>\n", motor_link, laser_link) +
         fmt::format(
             "  <joint name=\"{}\" type=\"continuous\">\n    <parent link=\"{}\"/>\n    <child "
             "link=\"{}\"/>\n",
             prefix + markup_line(joint_name(snippet.rig)), parent, motor_link) +
         fmt::format("    <origin xyz=\"0 0 0\" rpy=\"{}\"/>\n    <axis xyz=\"{}\"/>\n  </joint>\n",
                     numbers(motor.origin_rpy_rad), numbers(motor.axis)) +
         fmt::format(
             "  <joint name=\"{}\" type=\"fixed\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n",
             laser_link + "_mount", motor_link, laser_link) +
         fmt::format("    <origin xyz=\"{}\" rpy=\"{}\"/>\n  </joint>\n",
                     numbers(snippet.rig.mount.laser_in_motor_xyz_m), numbers(mount_rpy_rad(snippet.rig)));
}

std::string urdf(const RigSnippet& snippet) {
  auto lines = joined(head(snippet), {kUrdfSource, "robot_state_publisher turns it into transforms."});
  lines = joined(joined(lines, offset_by_transforms(snippet)), missing_parts(snippet.rig));
  const std::string base = markup_line(snippet.base_frame);
  return "<?xml version=\"1.0\"?>\n" + xml_comment(lines) + "<robot name=\"scanner\">\n" +
         fmt::format("  <link name=\"{}\"/>\n", base) + joints(snippet, "", base) + "</robot>\n";
}

std::string xacro(const RigSnippet& snippet) {
  auto lines = joined(head(snippet),
                      {kUrdfSource, "Macros: http://wiki.ros.org/xacro. Include this file, then:",
                       fmt::format("  <xacro:scanner parent=\"{}\"/>", markup_line(snippet.base_frame))});
  lines = joined(joined(lines, offset_by_transforms(snippet)), missing_parts(snippet.rig));
  return "<?xml version=\"1.0\"?>\n" + xml_comment(lines) +
         "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n" +
         fmt::format("<xacro:property name=\"scanner_offset_s\" value=\"{}\"/>\n",
                     number(snippet.offset.offset_s)) +
         "<xacro:macro name=\"scanner\" params=\"parent prefix:=''\">\n" +
         joints(snippet, "${prefix}", "${parent}") + "</xacro:macro>\n</robot>\n";
}

std::string ros2_static_tf(const RigSnippet& snippet) {
  const Eigen::Vector3d &xyz = snippet.rig.mount.laser_in_motor_xyz_m, rpy = mount_rpy_rad(snippet.rig);
  auto lines = joined(
      head(snippet),
      {"Options: ros2 run tf2_ros static_transform_publisher --help (m; rad about fixed axes, as in setRPY)",
       "The laser's pose in the frame that turns with the motor."});
  lines = joined(lines, turning_frame(snippet));
  lines = joined(joined(lines, offset_by_transforms(snippet)), missing_parts(snippet.rig));
  return "#!/bin/sh\n" + line_comment(lines, "#") + "ros2 run tf2_ros static_transform_publisher \\\n" +
         fmt::format("  --x {} --y {} --z {} \\\n", number(xyz.x()), number(xyz.y()), number(xyz.z())) +
         fmt::format("  --roll {} --pitch {} --yaw {} \\\n", number(rpy.x()), number(rpy.y()),
                     number(rpy.z())) +
         fmt::format("  --frame-id {} --child-frame-id {}\n", shell_word(snippet.motor_frame),
                     shell_word(snippet.laser_frame));
}

std::string laser_assembler(const RigSnippet& snippet) {
  const Eigen::Vector3d rpy = mount_rpy_rad(snippet.rig);
  auto lines = joined(
      head(snippet),
      {"A launch file of ROS 1. Parameters: http://wiki.ros.org/laser_assembler; static_transform_publisher "
       "takes",
       "x y z yaw pitch roll: http://wiki.ros.org/tf2_ros. With ignore_laser_skew false laser_geometry "
       "places each",
       "beam by the transforms at its own time; true, the default, takes one transform for a whole scan."});
  lines = joined(lines, turning_frame(snippet));
  lines = joined(joined(lines, offset_by_transforms(snippet)), missing_parts(snippet.rig));
  return "<?xml version=\"1.0\"?>\n" + xml_comment(lines) + "<launch>\n" +
         fmt::format(
             "  <node pkg=\"tf2_ros\" type=\"static_transform_publisher\" name=\"laser_mount\"\n"
             "        args=\"{} {} {} {} {} {}\"/>\n",
             numbers(snippet.rig.mount.laser_in_motor_xyz_m), number(rpy.z()), number(rpy.y()),
             number(rpy.x()), markup_line(snippet.motor_frame), markup_line(snippet.laser_frame)) +
         "  <node pkg=\"laser_assembler\" type=\"laser_scan_assembler\" name=\"laser_scan_assembler\">\n" +
         fmt::format("    <remap from=\"scan\" to=\"{}\"/>\n",
                     markup_line(snippet.rig.laser.topic.value_or("/scan"))) +
         fmt::format("    <param name=\"fixed_frame\" type=\"string\" value=\"{}\"/>\n",
                     markup_line(snippet.base_frame)) +
         "    <param name=\"max_scans\" type=\"int\" value=\"400\"/>\n"
         "    <param name=\"ignore_laser_skew\" type=\"bool\" value=\"false\"/>\n  </node>\n</launch>\n";
}

std::string cartographer(const RigSnippet& snippet) {
  auto lines = joined(
      head(snippet),
      {"Lines for the options of your Lua file. Keys:",
       "https://google-cartographer-ros.readthedocs.io/en/latest/configuration.html",
       "Cartographer has no key for a mount: it takes the laser's pose in tracking_frame from transforms",
       "(sweepscope rig --as urdf), at the middle of each part of a scan (sensor_bridge.cc). So a turning "
       "laser",
       "requires many parts. SLAM in 3D requires an IMU as well, and tracking_frame at its position."});
  lines = joined(joined(lines, offset_by_transforms(snippet)), missing_parts(snippet.rig));
  // Parts of at most 1 ms of a scanner with 40 scans a second.
  return line_comment(lines, "--") +
         fmt::format("options.tracking_frame = {0}\noptions.published_frame = {0}\n",
                     json_string(snippet.base_frame)) +
         fmt::format("-- remap scan to {}\n", printable_line(snippet.rig.laser.topic.value_or("/scan"))) +
         "options.num_laser_scans = 1\noptions.num_subdivisions_per_laser_scan = 25\n"
         "MAP_BUILDER.use_trajectory_builder_3d = true\n"
         "-- one sweep: 25 parts of each of its scans, for a sweep of 20 scans\n"
         "TRAJECTORY_BUILDER_3D.num_accumulated_range_data = 500\n";
}

std::string fast_lio(const RigSnippet& snippet) {
  const Rig::Imu& imu = snippet.rig.imu;
  const Pose base_from_imu{rotation_from_rpy(imu.pose_in_base_rpy_deg), imu.pose_in_base_xyz_m};
  const Pose imu_from_base = base_from_imu.inverse();
  const Eigen::Matrix3d r = imu_from_base.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = imu_from_base.translation_m;
  auto lines = joined(
      head(snippet),
      {"Keys: https://github.com/hku-mars/FAST_LIO, config/velodyne.yaml. FAST_LIO takes a fixed extrinsic, "
       "which a",
       "turning laser does not have. Give it clouds in the base frame, with the motor's motion removed:",
       fmt::format("  sweepscope apply REC -o OUT --offset-ms {:.6f} --clouds /sweeps --assume stationary",
                   snippet.offset.offset_s * 1e3),
       "time_offset_lidar_to_imu: FAST_LIO subtracts it from the IMU's stamps (imu_cbk in laserMapping.cpp), "
       "so",
       "t_imu = t_laser + time_offset_lidar_to_imu. That is the offset if the motor's clock stamps the IMU "
       "as",
       "well; write 0.0 if the IMU is stamped on the laser's clock.",
       "extrinsic_T, extrinsic_R: the pose of the clouds' frame in the IMU's: p_imu = R p_cloud + T."});
  if (!imu.topic)
    lines.emplace_back(
        "The rig file names no IMU: this is an IMU at the base frame. Add imu: {topic, pose_in_base}.");
  return line_comment(lines, "#") + "common:\n    lid_topic: \"/sweeps\"\n" +
         fmt::format("    imu_topic: {}\n", json_string(imu.topic.value_or("/imu/data"))) +
         "    time_sync_en: false\n" +
         fmt::format("    time_offset_lidar_to_imu: {}\n", number(snippet.offset.offset_s)) +
         "preprocess:\n    lidar_type: 2\n    timestamp_unit: 0  # the field time of the clouds is in "
         "seconds\n"
         "mapping:\n    extrinsic_est_en: false\n" +
         fmt::format("    extrinsic_T: [{}, {}, {}]\n", number(t.x()), number(t.y()), number(t.z())) +
         fmt::format(
             "    extrinsic_R: [{}, {}, {},\n                  {}, {}, {},\n                  {}, {}, {}]\n",
             number(r(0, 0)), number(r(0, 1)), number(r(0, 2)), number(r(1, 0)), number(r(1, 1)),
             number(r(1, 2)), number(r(2, 0)), number(r(2, 1)), number(r(2, 2)));
}

std::string driver_params(const RigSnippet& snippet) {
  auto lines = joined(
      head(snippet),
      {"Parameters by which drivers of lasers shift the header stamps of their scans, in seconds (REP 138). Each",
       "driver below adds its parameter: set the one of your driver. Its value is right if the recording was made",
       "with the driver's default; otherwise add the offset to the value that it was made with. Scans that are",
       "recorded from then on have an offset of 0. Your driver has no such parameter (rplidar_ros, LMS1xx,",
       "ldlidar_stl_ros2)? Shift the stamps of a recording, with sweepscope apply, or those of the motor."});
  if (snippet.rig.laser.stamp == StampSource::kReceive)
    lines.emplace_back(
        "This rig uses the laser's receive times, which no parameter shifts: estimate with --stamps header.");
  return driver_parameters_text(lines, snippet.offset.offset_s);
}

}  // namespace

const std::vector<std::string>& rig_system_names() {
  static const std::vector<std::string> names{"urdf",         "xacro",    "ros2-static-tf", "laser_assembler",
                                              "cartographer", "fast-lio", "driver-params"};
  return names;
}

std::string rig_snippet(const RigSnippet& snippet, RigSystem system) {
  switch (system) {
    case RigSystem::kUrdf:
      return urdf(snippet);
    case RigSystem::kXacro:
      return xacro(snippet);
    case RigSystem::kRos2StaticTf:
      return ros2_static_tf(snippet);
    case RigSystem::kLaserAssembler:
      return laser_assembler(snippet);
    case RigSystem::kCartographer:
      return cartographer(snippet);
    case RigSystem::kFastLio:
      return fast_lio(snippet);
    case RigSystem::kDriverParams:
      break;
  }
  return driver_params(snippet);
}

Eigen::Vector3d rpy_rad_of(const Eigen::Quaterniond& rotation) {
  constexpr double kGimbalLock = 1 - 1e-12;
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  const double sine = -r(2, 0);
  if (std::abs(sine) > kGimbalLock)
    return {std::atan2(sine * r(0, 1), r(1, 1)), std::copysign(M_PI_2, sine), 0};
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(sine), std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace sweepscope
