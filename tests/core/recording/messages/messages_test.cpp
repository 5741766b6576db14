#include "core/recording/messages/messages.hpp"

#include <std_msgs/Float32.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int32.h>

#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

template <typename Message>
std::vector<std::byte> serialised(const Message& message) {
  std::vector<std::byte> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

std::optional<std::vector<DecodedJoint>> joints_of(std::span<const std::byte> message) {
  std::vector<DecodedJoint> joints;
  if (!decode_joints(MessageKind::kJointState, Encoding::kRos1, message, Eigen::Vector3d::UnitX(), joints))
    return std::nullopt;
  return joints;
}

TEST(Messages, KnowTheSameVersionsAsTheirDefinitions) {
  const auto md5 = [](const char* type) { return find_message_type(type)->md5; };
  EXPECT_EQ(md5("sensor_msgs/LaserScan"), ros::message_traits::md5sum<test::LaserScanMessage>());
  EXPECT_EQ(md5("sensor_msgs/JointState"), ros::message_traits::md5sum<test::JointStateMessage>());
  EXPECT_EQ(md5("std_msgs/Float64"), ros::message_traits::md5sum<std_msgs::Float64>());
  EXPECT_EQ(md5("std_msgs/Float32"), ros::message_traits::md5sum<std_msgs::Float32>());
  EXPECT_EQ(md5("std_msgs/Int32"), ros::message_traits::md5sum<std_msgs::Int32>());
}

TEST(Messages, AreKnownByTheirNamesInRos1AndRos2) {
  EXPECT_EQ(find_message_type("sensor_msgs/LaserScan")->kind, MessageKind::kLaserScan);
  EXPECT_EQ(find_message_type("sensor_msgs/msg/LaserScan")->kind, MessageKind::kLaserScan);
  EXPECT_EQ(find_message_type("dynamixel_msgs/msg/JointState")->kind, MessageKind::kFields);
  EXPECT_EQ(find_message_type("tf2_msgs/msg/TFMessage")->kind, MessageKind::kTransforms);
  EXPECT_EQ(find_message_type("sensor_msgs/Imu")->kind, MessageKind::kImu);
  EXPECT_EQ(find_message_type("nav_msgs/msg/Odometry")->kind, MessageKind::kOdometry);
  for (const char* other : {"", "sensor_msgs/Image", "sensor_msgs/srv/LaserScan",
                            "sensor_msgs/msg/LaserScan2", "sensor_msgs/msg", "sensor_msgsmsg//LaserScan"}) {
    EXPECT_EQ(find_message_type(other), nullptr) << other;
  }
}

TEST(Messages, DecodesEveryFieldOfAScan) {
  test::LaserScanMessage sent = test::sample_scan(12.5, {1, 2, 3});
  sent.intensities = {10, 20, 30};
  const auto bytes = serialised(sent);
  const auto scan = decode_laser_scan(Encoding::kRos1, bytes);
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header_ns, 12'500'000'000);
  EXPECT_EQ(scan->angle_min_rad, sent.angle_min);
  EXPECT_EQ(scan->angle_max_rad, sent.angle_max);
  EXPECT_EQ(scan->angle_increment_rad, sent.angle_increment);
  EXPECT_EQ(scan->time_increment_s, sent.time_increment);
  EXPECT_EQ(scan->scan_time_s, sent.scan_time);
  EXPECT_EQ(scan->range_min_m, sent.range_min);
  EXPECT_EQ(scan->range_max_m, sent.range_max);
  std::vector<float> ranges_m, intensities;
  scan->ranges_m.append_to(ranges_m);
  scan->intensities.append_to(intensities);
  EXPECT_EQ(ranges_m, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(intensities, (std::vector<float>{10, 20, 30}));
}

TEST(Messages, DecodesNamesAndPositionsOfJoints) {
  test::JointStateMessage sent = test::sample_joints(3, {"left", "right"}, {0.25, -0.5});
  sent.velocity = {0, 0};
  const auto bytes = serialised(sent);
  const auto joints = joints_of(bytes);
  ASSERT_TRUE(joints);
  ASSERT_EQ(joints->size(), 2U);
  EXPECT_EQ(joints->at(0).header_ns, 3'000'000'000);
  EXPECT_EQ(joints->at(0).name, "left");
  EXPECT_EQ(joints->at(0).position, 0.25);
  EXPECT_EQ(joints->at(1).name, "right");
  EXPECT_EQ(joints->at(1).position, -0.5);
}

TEST(Messages, AcceptsJointsWithoutPositionsButNotWithTooFew) {
  EXPECT_TRUE(joints_of(serialised(test::sample_joints(3, {"left"}, {}))));
  EXPECT_FALSE(joints_of(serialised(test::sample_joints(3, {"left", "right"}, {1}))));
}

TEST(Messages, EveryCutIsMalformed) {
  const auto scan = serialised(test::sample_scan(1));
  const auto joints = serialised(test::sample_joints(1, {"left", "right"}, {1, 2}));
  for (std::size_t n = 0; n < scan.size(); ++n)
    EXPECT_FALSE(decode_laser_scan(Encoding::kRos1, std::span(scan).first(n))) << n;
  for (std::size_t n = 0; n < joints.size(); ++n) EXPECT_FALSE(joints_of(std::span(joints).first(n))) << n;
}

TEST(Messages, ALengthThatTheMessageDoesNotHoldIsMalformed) {
  auto scan = serialised(test::sample_scan(1));
  const std::size_t ranges_at =
      scan.size() - 4 - 5 * 4 - 4;  // before the count of intensities, and five ranges
  for (const int top_byte : {0x01, 0x40, 0x7F, 0xFF}) {
    scan[ranges_at + 3] = std::byte(top_byte);
    EXPECT_FALSE(decode_laser_scan(Encoding::kRos1, scan));
  }
  std::vector<std::byte> names = serialised(test::sample_joints(1, {"left"}, {1}));
  names[16 + 3] = std::byte{0xFF};  // the count of names, after the header
  std::vector<DecodedJoint> joints;
  EXPECT_FALSE(
      decode_joints(MessageKind::kJointState, Encoding::kRos1, names, Eigen::Vector3d::UnitX(), joints));
  EXPECT_LT(joints.capacity(), 100U);
}

TEST(Messages, BytesLeftOverAreMalformed) {
  auto scan = serialised(test::sample_scan(1));
  scan.push_back(std::byte{0});
  EXPECT_FALSE(decode_laser_scan(Encoding::kRos1, scan));
}

}  // namespace
}  // namespace sweepscope
