#include "core/recording/ros2/cdr_writer.hpp"

#include <span>

#include "core/recording/messages/message_writer.hpp"

namespace sweepscope {
std::string cdr_laser_scan(const RawLaser& laser, std::size_t scan) {
  const RawScan& raw = laser.scans[scan];
  MessageWriter writer(Encoding::kCdr);
  writer.header(raw.stamps.header_ns, "laser");
  for (const float value : {raw.angle_min_rad, raw.angle_max_rad, raw.angle_increment_rad,
                            raw.time_increment_s, raw.scan_time_s, raw.range_min_m, raw.range_max_m}) {
    writer.number(value);
  }
  writer.array(std::span(laser.ranges_m).subspan(raw.first_range, raw.beams));
  writer.array(laser.has_intensities ? std::span(laser.intensities).subspan(raw.first_range, raw.beams)
                                     : std::span<const float>());
  return writer.take();
}

std::string cdr_cloud(const RawCloud& cloud) {
  MessageWriter writer(Encoding::kCdr);
  writer.header(cloud.stamps.header_ns, cloud.frame);
  writer.number(cloud.height);
  writer.number(cloud.width);
  writer.number(static_cast<std::uint32_t>(cloud.fields.size()));
  for (const RawCloud::Field& field : cloud.fields) {
    writer.text(field.name);
    writer.number(field.offset);
    writer.number(field.datatype);
    writer.number(field.count);
  }
  writer.number(static_cast<std::uint8_t>(cloud.big_endian));
  writer.number(cloud.point_bytes);
  writer.number(cloud.row_bytes);
  writer.array(std::span(cloud.data));
  writer.number(static_cast<std::uint8_t>(cloud.dense));
  return writer.take();
}

std::string cdr_joint_state(const RawJoint& joint, std::size_t sample) {
  MessageWriter writer(Encoding::kCdr);
  writer.header(joint.stamps[sample].header_ns, "");
  writer.number(std::uint32_t{1});
  writer.text(joint.joint);
  writer.array(std::span(&joint.positions[sample], 1));
  writer.array(std::span<const double>());  // velocity and effort
  writer.array(std::span<const double>());
  return writer.take();
}

std::string header_definition() {
  return "================================================================================\n"
         "MSG: std_msgs/Header\n"
         "builtin_interfaces/Time stamp\n"
         "string frame_id\n"
         "================================================================================\n"
         "MSG: builtin_interfaces/Time\n"
         "int32 sec\n"
         "uint32 nanosec\n";
}

namespace {

std::string with_header(const char* members) {
  return std::string("std_msgs/Header header\n") + members + header_definition();
}

}  // namespace

std::string laser_scan_definition() {
  return with_header(
      "float32 angle_min\n"
      "float32 angle_max\n"
      "float32 angle_increment\n"
      "float32 time_increment\n"
      "float32 scan_time\n"
      "float32 range_min\n"
      "float32 range_max\n"
      "float32[] ranges\n"
      "float32[] intensities\n");
}

std::string point_cloud_definition() {
  return with_header(
      "uint32 height\n"
      "uint32 width\n"
      "PointField[] fields\n"
      "bool is_bigendian\n"
      "uint32 point_step\n"
      "uint32 row_step\n"
      "uint8[] data\n"
      "bool is_dense\n"
      "================================================================================\n"
      "MSG: sensor_msgs/PointField\n"
      "uint8 INT8=1\n"
      "uint8 UINT8=2\n"
      "uint8 INT16=3\n"
      "uint8 UINT16=4\n"
      "uint8 INT32=5\n"
      "uint8 UINT32=6\n"
      "uint8 FLOAT32=7\n"
      "uint8 FLOAT64=8\n"
      "string name\n"
      "uint32 offset\n"
      "uint8 datatype\n"
      "uint32 count\n");
}

std::string joint_state_definition() {
  return with_header(
      "string[] name\n"
      "float64[] position\n"
      "float64[] velocity\n"
      "float64[] effort\n");
}

}  // namespace sweepscope
