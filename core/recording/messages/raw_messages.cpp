#include "core/recording/messages/raw_messages.hpp"

#include <span>

namespace sweepscope {
namespace {

template <typename T>
PackedArray<T> packed(std::span<const T> numbers) {
  return {std::as_bytes(numbers), false};
}

std::string cloud_message(Encoding encoding, const RawCloud& cloud, std::uint32_t number) {
  CloudMessage message;
  message.header_ns = cloud.stamps.header_ns;
  message.frame = cloud.frame;
  message.height = cloud.height;
  message.width = cloud.width;
  message.point_bytes = cloud.point_bytes;
  message.row_bytes = cloud.row_bytes;
  for (const RawCloud::Field& field : cloud.fields)
    message.fields.push_back({field.name, field.offset, field.datatype, field.count});
  message.data = cloud.data;
  message.swapped = cloud.big_endian;
  message.dense = cloud.dense;
  return encode(encoding, message, number);
}

}  // namespace

std::string message_of(Encoding encoding, const RawLaser& laser, std::size_t number) {
  const auto sequence = static_cast<std::uint32_t>(number);
  if (laser.of_clouds) return cloud_message(encoding, laser.clouds[number], sequence);
  const RawScan& scan = laser.scans[number];
  const auto numbers_of_scan = [&](const std::vector<float>& all) {
    return packed(std::span(all).subspan(scan.first_range, scan.beams));
  };
  ScanMessage message;
  message.header_ns = scan.stamps.header_ns;
  message.frame = "laser";
  message.angle_min_rad = scan.angle_min_rad;
  message.angle_max_rad = scan.angle_max_rad;
  message.angle_increment_rad = scan.angle_increment_rad;
  message.time_increment_s = scan.time_increment_s;
  message.scan_time_s = scan.scan_time_s;
  message.range_min_m = scan.range_min_m;
  message.range_max_m = scan.range_max_m;
  message.ranges_m = numbers_of_scan(laser.ranges_m);
  if (laser.has_intensities) message.intensities = numbers_of_scan(laser.intensities);
  return encode(encoding, message, sequence);
}

std::string message_of(Encoding encoding, const RawJoint& joint, std::size_t number) {
  constexpr double kZero = 0;
  JointStateMessage message;
  message.header_ns = joint.stamps[number].header_ns;
  message.joints = {{0, joint.joint, 0}};
  message.positions = packed(std::span(&joint.positions[number], 1));
  // As many drivers of ROS 1 leave them.
  if (encoding == Encoding::kRos1) message.velocities = message.efforts = packed(std::span(&kZero, 1));
  return encode(encoding, message, static_cast<std::uint32_t>(number));
}

std::string message_of(Encoding encoding, const RawTurnRates& rates, std::size_t number) {
  ImuMessage message;
  message.header_ns = rates.stamps[number].header_ns;
  message.frame = "imu";
  message.rate_rad_s = rates.rates_rad_s[number];
  message.orientation_covariance[0] = message.acceleration_covariance[0] = -1;  // not measured
  return encode(encoding, message, static_cast<std::uint32_t>(number));
}

}  // namespace sweepscope
