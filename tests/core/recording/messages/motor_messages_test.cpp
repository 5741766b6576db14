#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <vector>

#include "core/recording/messages/joint_reader.hpp"
#include "core/recording/messages/messages.hpp"
#include "tests/core/recording/message_bytes.hpp"

namespace sweepscope {
namespace {

using test::as_span, test::MessageBytes;

class MotorMessageForms : public testing::TestWithParam<MessageBytes::Form> {
 protected:
  Encoding encoding() const { return GetParam() == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr; }
  std::optional<std::vector<DecodedJoint>> joints(
      MessageKind kind, std::span<const std::byte> message,
      const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX()) const {
    std::vector<DecodedJoint> decoded;
    if (!decode_joints(kind, encoding(), message, axis, decoded)) return std::nullopt;
    return decoded;
  }
  /// Of a type that is read by its definition. Names are valid until the next call.
  std::optional<std::vector<DecodedJoint>> joints(const std::string& type,
                                                  std::span<const std::byte> message) {
    reader_ = JointReader::by_definition({"/motor", type, encoding()}, {}, {}).value();
    std::vector<DecodedJoint> decoded;
    if (!reader_.read(message, Eigen::Vector3d::UnitX(), decoded)) return std::nullopt;
    return decoded;
  }
  /// Every cut of the message is malformed, and so is a byte too many for any filling.
  template <typename Type>
  void expect_whole_only(const Type& type, const std::string& message) {
    for (std::size_t n = 0; n < message.size(); ++n)
      EXPECT_FALSE(joints(type, as_span(message).first(n))) << "cut to " << n << " of " << message.size();
    const std::string longer = message + std::string(GetParam() == MessageBytes::kRos1 ? 1 : 4, '\0');
    EXPECT_FALSE(joints(type, as_span(longer)));
  }

 private:
  JointReader reader_;
};
INSTANTIATE_TEST_SUITE_P(Ros1AndRos2, MotorMessageForms,
                         testing::Values(MessageBytes::kRos1, MessageBytes::kCdr,
                                         MessageBytes::kCdrBigEndian));

TEST_P(MotorMessageForms, AScanIsDecodedInFull) {
  const std::string bytes = test::scan_bytes(GetParam(), 12, 500'000'000, {1, 2.5F, 3}, {10, 20, 30});
  const auto scan = decode_laser_scan(encoding(), as_span(bytes));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->header_ns, 12'500'000'000);
  EXPECT_EQ(scan->angle_min_rad, -0.5F);
  EXPECT_EQ(scan->angle_max_rad, 0.5F);
  EXPECT_EQ(scan->angle_increment_rad, 0.25F);
  EXPECT_EQ(scan->time_increment_s, 0.001F);
  EXPECT_EQ(scan->scan_time_s, 0.025F);
  EXPECT_EQ(scan->range_min_m, 0.1F);
  EXPECT_EQ(scan->range_max_m, 30);
  std::vector<float> ranges_m, intensities;
  scan->ranges_m.append_to(ranges_m);
  scan->intensities.append_to(intensities);
  EXPECT_EQ(ranges_m, (std::vector<float>{1, 2.5F, 3}));
  EXPECT_EQ(intensities, (std::vector<float>{10, 20, 30}));
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(decode_laser_scan(encoding(), as_span(bytes).first(n))) << n;
}

TEST_P(MotorMessageForms, JointStatesOfAnyNamesLengths) {
  for (const std::string name : {"", "a", "ab", "abc", "roll_motor"}) {
    const std::string bytes = test::joint_bytes(GetParam(), 3, 1, {name, "other"}, {0.25, -0.5});
    const auto decoded = joints(MessageKind::kJointState, as_span(bytes));
    ASSERT_TRUE(decoded) << name;
    ASSERT_EQ(decoded->size(), 2U);
    EXPECT_EQ(decoded->at(0).name, name);
    EXPECT_EQ(decoded->at(0).header_ns, 3'000'000'001);
    EXPECT_EQ(decoded->at(0).position, 0.25);
    EXPECT_EQ(decoded->at(1).position, -0.5);
  }
  expect_whole_only(MessageKind::kJointState, test::joint_bytes(GetParam(), 3, 1, {"a"}, {1}));
  EXPECT_FALSE(
      joints(MessageKind::kJointState, as_span(test::joint_bytes(GetParam(), 3, 1, {"a", "b"}, {1}))));
}

TEST_P(MotorMessageForms, PlainNumbersHaveNoHeaderAndAreCalledData) {
  const std::string wide = MessageBytes(GetParam()).number(-1.25).bytes();
  const std::string narrow = MessageBytes(GetParam()).number(0.5F).bytes();
  const std::string whole = MessageBytes(GetParam()).number(std::int32_t{-90}).bytes();
  const auto of_wide = joints("std_msgs/Float64", as_span(wide));
  ASSERT_TRUE(of_wide);
  EXPECT_EQ(of_wide->at(0).position, -1.25);
  EXPECT_EQ(of_wide->at(0).name, "data");
  EXPECT_EQ(of_wide->at(0).header_ns, 0);
  EXPECT_EQ(joints("std_msgs/Float32", as_span(narrow))->at(0).position, 0.5);
  EXPECT_EQ(joints("std_msgs/Int32", as_span(whole))->at(0).position, -90);
  expect_whole_only("std_msgs/Float64", wide);
  expect_whole_only("std_msgs/Float32", narrow);
  expect_whole_only("std_msgs/Int32", whole);
}

TEST_P(MotorMessageForms, ADynamixelsPositionIsItsCurrentOne) {
  const std::string bytes = MessageBytes(GetParam())
                                .header(5, 6, "")
                                .text("tilt")
                                .array(std::vector<std::int32_t>{1})
                                .array(std::vector<std::int32_t>{40})
                                .number(0.9)    // goal
                                .number(0.75)   // current
                                .number(-0.15)  // error
                                .number(0.1)
                                .number(0.2)
                                .number(std::uint8_t{1})
                                .bytes();
  const auto decoded = joints("dynamixel_msgs/JointState", as_span(bytes));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->at(0).name, "tilt");
  EXPECT_EQ(decoded->at(0).position, 0.75);
  EXPECT_EQ(decoded->at(0).header_ns, 5'000'000'006);
  expect_whole_only("dynamixel_msgs/JointState", bytes);
}

MessageBytes& transform(MessageBytes& message, const std::string& child, const Eigen::Quaterniond& rotation) {
  message.header(2, 3, "base").text(child);
  for (const double part : {0.1, 0.2, 0.3, rotation.x(), rotation.y(), rotation.z(), rotation.w()})
    message.number(part);
  return message;
}

TEST_P(MotorMessageForms, ATransformsAngleIsThatAboutTheRigsAxis) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  MessageBytes message(GetParam());
  message.number(std::uint32_t{3});
  transform(message, "tilted", Eigen::Quaterniond(Eigen::AngleAxisd(0.7, axis)));
  transform(message, "back", Eigen::Quaterniond(Eigen::AngleAxisd(-3.0, axis)));
  transform(message, "aside", Eigen::Quaterniond(Eigen::AngleAxisd(1.0, axis.unitOrthogonal())));
  const auto decoded = joints(MessageKind::kTransforms, as_span(message.bytes()), axis);
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->size(), 3U);
  EXPECT_EQ(decoded->at(0).name, "tilted");
  EXPECT_EQ(decoded->at(0).header_ns, 2'000'000'003);
  EXPECT_NEAR(decoded->at(0).position, 0.7, 1e-15);
  EXPECT_NEAR(decoded->at(1).position, -3.0, 1e-15);
  EXPECT_NEAR(decoded->at(2).position, 0, 1e-15);
  expect_whole_only(MessageKind::kTransforms, message.bytes());
}

TEST_P(MotorMessageForms, TheSameRotationHasOneAngleWhateverTheQuaternionsSign) {
  Eigen::Quaterniond rotation(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY()));
  MessageBytes message(GetParam());
  message.number(std::uint32_t{2});
  transform(message, "a", rotation);
  rotation.coeffs() *= -1;
  transform(message, "b", rotation);
  const auto decoded = joints(MessageKind::kTransforms, as_span(message.bytes()), Eigen::Vector3d::UnitY());
  ASSERT_TRUE(decoded);
  EXPECT_NEAR(decoded->at(0).position, 2.5, 1e-15);
  EXPECT_NEAR(decoded->at(1).position, 2.5, 1e-15);
}

TEST_P(MotorMessageForms, CountsThatTheMessageDoesNotHoldAllocateNothing) {
  for (const MessageKind kind : {MessageKind::kTransforms, MessageKind::kJointState}) {
    MessageBytes message(GetParam());
    if (kind == MessageKind::kJointState) message.header(1, 1, "");
    message.number(std::uint32_t{0xFFFFFFFF}).fill(40);
    std::vector<DecodedJoint> decoded;
    EXPECT_FALSE(
        decode_joints(kind, encoding(), as_span(message.bytes()), Eigen::Vector3d::UnitX(), decoded));
    EXPECT_LT(decoded.capacity(), 100U);
  }
}

bool is_float64(const std::string& bytes) {
  std::vector<DecodedJoint> joints;
  return JointReader::by_definition({"/motor", "std_msgs/Float64", Encoding::kCdr}, {}, {})
      ->read(as_span(bytes), Eigen::Vector3d::UnitX(), joints);
}

TEST(Cdr, FillingToFourBytesIsAccepted) {
  for (const std::size_t filling : {1, 2, 3}) {
    const std::string bytes = MessageBytes(MessageBytes::kCdr).number(1.5).fill(filling).bytes();
    EXPECT_TRUE(is_float64(bytes));
  }
}

TEST(Cdr, OtherRepresentationsAreMalformed) {
  std::string bytes = MessageBytes(MessageBytes::kCdr).number(1.5).bytes();
  for (const char representation : {'\x02', '\x03', '\x07', '\x0B'}) {
    bytes[1] = representation;
    EXPECT_FALSE(is_float64(bytes));
  }
}

TEST(Cdr, AStampBefore1970IsNone) {
  const std::string bytes = test::scan_bytes(MessageBytes::kCdr, 0xFFFFFFFF, 5, {1});
  EXPECT_EQ(decode_laser_scan(Encoding::kCdr, as_span(bytes))->header_ns, 0);
}

}  // namespace
}  // namespace sweepscope
