#include "core/live/live_messages.hpp"

#include <cstring>

#include "core/apply/added_messages.hpp"

namespace sweepscope {

std::vector<StreamTopic> live_topics() {
  StreamTopic offset{
      "/sweepscope/offset_ms", "std_msgs/Float64", "ros1", "ros1msg", "float64 data\n", "", {}};
  offset.metadata.emplace_back("md5sum", "fdb28210bfa9d7c91146260178d9a584");
  return {written_topic("/sweepscope/cloud", "sensor_msgs/PointCloud2", Encoding::kRos1),
          written_topic("/tf", "tf2_msgs/TFMessage", Encoding::kRos1), offset};
}

LiveMessage live_message(const LiveCloud& cloud, const std::string& base_frame) {
  return {LiveTopic::kCloud, cloud.stamp_ns(),
          cloud_message(Encoding::kRos1, cloud.stamp_ns(), base_frame, cloud.points, cloud.begin_s)};
}

LiveMessage live_message(std::span<const LivePose> poses, const std::string& base_frame,
                         const std::string& laser_frame) {
  // A list of ROS 1: its length, and the transforms one after the other.
  const auto count = static_cast<std::uint32_t>(poses.size());
  std::string bytes(sizeof count, '\0');
  std::memcpy(bytes.data(), &count, sizeof count);
  for (const LivePose& pose : poses)
    bytes += transform_message(Encoding::kRos1, pose.stamp_ns, base_frame, laser_frame, pose.base_from_laser)
                 .substr(sizeof count);
  return {LiveTopic::kTransform, poses.back().stamp_ns, bytes};
}

LiveMessage live_offset_message(double offset_s, std::int64_t stamp_ns) {
  const double offset_ms = offset_s * 1e3;
  std::string bytes(sizeof offset_ms, '\0');
  std::memcpy(bytes.data(), &offset_ms, sizeof offset_ms);  // the machine is little-endian, see messages.cpp
  return {LiveTopic::kOffset, stamp_ns, bytes};
}

}  // namespace sweepscope
