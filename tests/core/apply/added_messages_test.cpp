#include "core/apply/added_messages.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <sensor_msgs/PointCloud2.h>

#include "core/recording/streams/message_stream.hpp"
#include "tests/core/recording/message_allocator.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kStamp_ns = 1'700'000'000'123'456'789;

std::span<const std::byte> bytes_of(const std::string& message) {
  return std::as_bytes(std::span(message));
}

MapCloud two_points() {
  MapCloud cloud;
  for (const float x : {1.5F, -2.0F}) {
    MapPoint point{};
    point.x = x;
    point.y = 2 * x;
    point.z = 3 * x;
    point.intensity = 7;
    point.time_s = 10.0 + x / 100;
    cloud.push_back(point);
  }
  return cloud;
}

TEST(AddedMessages, ACloudReadsBackInEitherSerialisation) {
  for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
    const std::string message = cloud_message(encoding, kStamp_ns, "base_link", two_points(), 9.9);
    const auto cloud = decode_cloud(encoding, bytes_of(message));
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->header_ns, kStamp_ns);
    EXPECT_EQ(cloud->frame, "base_link");
    ASSERT_EQ(cloud->points(), 2U);
    const std::vector<double> expected{-2, -4, -6, 7, 0.08};
    ASSERT_EQ(cloud->fields.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(cloud->value(1, cloud->fields[i]), expected[i], 1e-6) << cloud->fields[i].name;
    EXPECT_EQ(cloud->fields[4].name, "time");
  }
}

TEST(AddedMessages, RosReadsACloudOfItsOwnKind) {
  std::string message = cloud_message(Encoding::kRos1, kStamp_ns, "base_link", two_points(), 9.9);
  ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(message.data()),
                                     static_cast<std::uint32_t>(message.size()));
  sensor_msgs::PointCloud2_<MessageAllocator<void>> cloud;
  ros::serialization::deserialize(stream, cloud);
  EXPECT_EQ(stream.getLength(), 0U);
  EXPECT_EQ(cloud.header.stamp.toNSec(), static_cast<std::uint64_t>(kStamp_ns));
  EXPECT_EQ(cloud.width * cloud.height, 2U);
  EXPECT_EQ(cloud.row_step, cloud.data.size());
  EXPECT_TRUE(cloud.is_dense);
}

TEST(AddedMessages, ATransformReadsBackInEitherSerialisation) {
  const Pose pose{rotation_from_vector({0.1, -0.2, 0.3}), {1, 2, 3}};
  for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
    const std::string message = transform_message(encoding, kStamp_ns, "base_link", "laser", pose);
    std::vector<TransformMessage> transforms;
    ASSERT_TRUE(decode_transforms(encoding, bytes_of(message), transforms));
    ASSERT_EQ(transforms.size(), 1U);
    EXPECT_EQ(transforms[0].header_ns, kStamp_ns);
    EXPECT_EQ(transforms[0].parent, "base_link");
    EXPECT_EQ(transforms[0].child, "laser");
    EXPECT_EQ(transforms[0].translation_m, pose.translation_m);
    EXPECT_LT(transforms[0].rotation.angularDistance(pose.rotation), 1e-12);
  }
}

TEST(AddedMessages, TopicsNameTypesThatAreKnown) {
  for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
    for (const StreamTopic& topic : {written_topic("/sweeps", "sensor_msgs/PointCloud2", encoding),
                                     written_topic("/tf", "tf2_msgs/TFMessage", encoding)}) {
      ASSERT_NE(find_message_type(topic.type), nullptr) << topic.type;
      EXPECT_NE(topic.definition.find("string frame_id"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace sweepscope
