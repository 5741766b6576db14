#include "core/apply/added_messages.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/PointCloud2.h>

#include <array>

#include "core/recording/messages/message_writer.hpp"
#include "core/recording/ros1/ros_libraries.hpp"
#include "core/recording/ros2/cdr_writer.hpp"

namespace sweepscope {
namespace {

constexpr const char* kRule =
    "================================================================================\n";

std::string ros1_transform_definition() {
  using Transform = geometry_msgs::TransformStamped_<MessageAllocator<void>>;
  return std::string("geometry_msgs/TransformStamped[] transforms\n\n") + kRule +
         "MSG: geometry_msgs/TransformStamped\n" + ros::message_traits::Definition<Transform>::value();
}

std::string ros2_transform_definition() {
  const std::string rule = kRule;
  return "geometry_msgs/TransformStamped[] transforms\n" + rule + "MSG: geometry_msgs/TransformStamped\n" +
         "std_msgs/Header header\nstring child_frame_id\nTransform transform\n" + rule +
         "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n" + rule +
         "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" + rule +
         "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n" +
         header_definition();
}

StreamTopic topic_of(const std::string& name, const char* package, const char* type, Encoding encoding,
                     std::string definition) {
  const bool ros1 = encoding == Encoding::kRos1;
  StreamTopic topic;
  topic.name = name;
  topic.type = std::string(package) + (ros1 ? "/" : "/msg/") + type;
  topic.encoding = ros1 ? "ros1" : "cdr";
  topic.schema_encoding = ros1 ? "ros1msg" : "ros2msg";
  topic.definition = std::move(definition);
  const MessageType* known = find_message_type(topic.type);
  if (ros1 && known != nullptr) topic.metadata.emplace_back("md5sum", known->md5);
  return topic;
}

}  // namespace

StreamTopic cloud_topic(const std::string& name, Encoding encoding) {
  using Cloud = sensor_msgs::PointCloud2_<MessageAllocator<void>>;
  return topic_of(name, "sensor_msgs", "PointCloud2", encoding,
                  encoding == Encoding::kRos1 ? ros::message_traits::Definition<Cloud>::value()
                                              : point_cloud_definition());
}

StreamTopic transform_topic(Encoding encoding) {
  return topic_of("/tf", "tf2_msgs", "TFMessage", encoding,
                  encoding == Encoding::kRos1 ? ros1_transform_definition() : ros2_transform_definition());
}

std::string cloud_message(Encoding encoding, std::int64_t stamp_ns, std::string_view frame,
                          const MapCloud& cloud, double begin_s) {
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::array<const char*, 5> kFields{"x", "y", "z", "intensity", "time"};
  constexpr std::uint32_t kPoint_bytes = kFields.size() * sizeof(float);
  const auto points = static_cast<std::uint32_t>(cloud.size());
  MessageWriter writer(encoding);
  writer.header(stamp_ns, frame);
  writer.number(std::uint32_t{1});  // height
  writer.number(points);
  writer.number(static_cast<std::uint32_t>(kFields.size()));
  for (std::size_t i = 0; i < kFields.size(); ++i) {
    writer.text(kFields[i]);
    writer.number(static_cast<std::uint32_t>(i * sizeof(float)));
    writer.number(kFloat32);
    writer.number(std::uint32_t{1});
  }
  writer.number(std::uint8_t{0});  // little-endian
  writer.number(kPoint_bytes);
  writer.number(points * kPoint_bytes);
  std::vector<float> values;
  values.reserve(cloud.size() * kFields.size());
  for (const MapPoint& point : cloud.points) {
    const auto time_s = static_cast<float>(point.time_s - begin_s);
    values.insert(values.end(), {point.x, point.y, point.z, point.intensity, time_s});
  }
  writer.array(std::as_bytes(std::span(values)));
  writer.number(std::uint8_t{1});  // dense
  return writer.take();
}

std::string transform_message(Encoding encoding, std::int64_t stamp_ns, std::string_view parent,
                              std::string_view child, const Pose& parent_from_child) {
  const Eigen::Vector3d& t_m = parent_from_child.translation_m;
  const Eigen::Quaterniond& q = parent_from_child.rotation;
  MessageWriter writer(encoding);
  writer.number(std::uint32_t{1});  // transform
  writer.header(stamp_ns, parent);
  writer.text(child);
  for (const double value : {t_m.x(), t_m.y(), t_m.z(), q.x(), q.y(), q.z(), q.w()}) writer.number(value);
  return writer.take();
}

}  // namespace sweepscope
