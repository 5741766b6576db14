#include "core/recording/ros1_messages.hpp"

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

TEST(Ros1Messages, KnowTheSameVersionsAsTheirDefinitions) {
  EXPECT_EQ(kLaserScanMd5, ros::message_traits::md5sum<test::LaserScanMessage>());
  EXPECT_EQ(kLaserScanType, ros::message_traits::datatype<test::LaserScanMessage>());
  EXPECT_EQ(kJointStateMd5, ros::message_traits::md5sum<test::JointStateMessage>());
  EXPECT_EQ(kJointStateType, ros::message_traits::datatype<test::JointStateMessage>());
}

TEST(Ros1Messages, DecodesEveryFieldOfAScan) {
  test::LaserScanMessage sent = test::sample_scan(12.5, {1, 2, 3});
  sent.intensities = {10, 20, 30};
  const auto bytes = serialised(sent);
  const auto scan = decode_laser_scan(bytes);
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

TEST(Ros1Messages, DecodesNamesAndPositionsOfJoints) {
  test::JointStateMessage sent = test::sample_joints(3, {"left", "right"}, {0.25, -0.5});
  sent.velocity = {0, 0};
  const auto bytes = serialised(sent);
  Ros1JointState state;
  ASSERT_TRUE(decode_joint_state(bytes, state));
  EXPECT_EQ(state.header_ns, 3'000'000'000);
  EXPECT_EQ(state.names, (std::vector<std::string_view>{"left", "right"}));
  EXPECT_EQ(state.positions[0], 0.25);
  EXPECT_EQ(state.positions[1], -0.5);
}

TEST(Ros1Messages, AcceptsJointsWithoutPositionsButNotWithTooFew) {
  Ros1JointState state;
  EXPECT_TRUE(decode_joint_state(serialised(test::sample_joints(3, {"left"}, {})), state));
  EXPECT_FALSE(decode_joint_state(serialised(test::sample_joints(3, {"left", "right"}, {1})), state));
}

TEST(Ros1Messages, EveryCutIsMalformed) {
  const auto scan = serialised(test::sample_scan(1));
  const auto joints = serialised(test::sample_joints(1, {"left", "right"}, {1, 2}));
  Ros1JointState state;
  for (std::size_t n = 0; n < scan.size(); ++n)
    EXPECT_FALSE(decode_laser_scan(std::span(scan).first(n))) << n;
  for (std::size_t n = 0; n < joints.size(); ++n)
    EXPECT_FALSE(decode_joint_state(std::span(joints).first(n), state)) << n;
}

TEST(Ros1Messages, ALengthThatTheMessageDoesNotHoldIsMalformed) {
  auto scan = serialised(test::sample_scan(1));
  const std::size_t ranges_at =
      scan.size() - 4 - 5 * 4 - 4;  // before the count of intensities, and five ranges
  for (const int top_byte : {0x01, 0x40, 0x7F, 0xFF}) {
    scan[ranges_at + 3] = std::byte(top_byte);
    EXPECT_FALSE(decode_laser_scan(scan));
  }
  std::vector<std::byte> names = serialised(test::sample_joints(1, {"left"}, {1}));
  names[16 + 3] = std::byte{0xFF};  // the count of names, after the header
  Ros1JointState state;
  EXPECT_FALSE(decode_joint_state(names, state));
  EXPECT_LT(state.names.capacity(), 100U);
}

TEST(Ros1Messages, BytesLeftOverAreMalformed) {
  auto scan = serialised(test::sample_scan(1));
  scan.push_back(std::byte{0});
  EXPECT_FALSE(decode_laser_scan(scan));
}

}  // namespace
}  // namespace sweepscope
