#include "core/apply/added_messages.hpp"

#include <array>

namespace sweepscope {

std::string cloud_message(Encoding encoding, std::int64_t stamp_ns, std::string_view frame,
                          const MapCloud& cloud, double begin_s) {
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::array<const char*, 5> kFields{"x", "y", "z", "intensity", "time"};
  std::vector<float> values;
  values.reserve(cloud.size() * kFields.size());
  for (const MapPoint& point : cloud.points) {
    const auto time_s = static_cast<float>(point.time_s - begin_s);
    values.insert(values.end(), {point.x, point.y, point.z, point.intensity, time_s});
  }
  CloudMessage message;
  message.header_ns = stamp_ns;
  message.frame = frame;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(cloud.size());
  message.point_bytes = kFields.size() * sizeof(float);
  message.row_bytes = message.width * message.point_bytes;
  for (std::uint32_t i = 0; i < kFields.size(); ++i)
    message.fields.push_back({kFields[i], i * std::uint32_t{sizeof(float)}, kFloat32, 1});
  message.data = std::as_bytes(std::span(values));
  message.dense = true;
  return encode(encoding, message);
}

Pose base_from_laser(const Mount& mount, double angle_rad) {
  const Pose motor_from_laser{rotation_from_rpy(mount.laser_in_motor_rpy_deg), mount.laser_in_motor_xyz_m};
  const Pose base_from_motor{rotation_from_vector(angle_rad * mount.axis.normalized()),
                             Eigen::Vector3d::Zero()};
  return base_from_motor * motor_from_laser;
}

std::string transform_message(Encoding encoding, std::int64_t stamp_ns, std::string_view parent,
                              std::string_view child, const Pose& parent_from_child) {
  return encode(encoding,
                std::vector<TransformMessage>{
                    {stamp_ns, parent, child, parent_from_child.translation_m, parent_from_child.rotation}});
}

}  // namespace sweepscope
