#include "core/recording/messages/joint_reader.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/core/recording/message_bytes.hpp"

namespace sweepscope {
namespace {

using test::as_span, test::MessageBytes;

constexpr const char* kState =
    "# state of one's own motor\n"
    "Header header\n"
    "uint8 OK=0\n"
    "string NAME = a # text\n"
    "uint8 status   # comment\n"
    "float64[] position\n"
    "Encoder[2] encoders\n"
    "string text\n"
    "================================================================================\n"
    "MSG: my_msgs/Encoder\n"
    "bool on\n"
    "int64 ticks\n"
    "string<=8 name \"a b\"\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\n";

class JointsByDefinition : public testing::TestWithParam<MessageBytes::Form> {
 protected:
  Encoding encoding() const { return GetParam() == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr; }
  MessageTopic topic(const std::string& type, const std::string& definition = "") const {
    return {"/state", type, encoding(), true, "*", definition};
  }
  Result<JointReader> reader(const MessageTopic& topic, const std::optional<std::string>& field = {}) const {
    return JointReader::by_definition(topic, field, std::nullopt);
  }
  /// A kState of three positions.
  std::string state() const {
    MessageBytes message(GetParam());
    message.header(7, 8, "base").number(std::uint8_t{1}).array(std::vector<double>{0.5, 1.5, -2.5});
    for (const std::int64_t ticks : {40, -50}) message.number(std::uint8_t{1}).number(ticks).text("e");
    return message.text("end").bytes();
  }
  std::string refusal(const MessageTopic& of, const std::optional<std::string>& field = {}) const {
    const auto made = reader(of, field);
    return made ? "accepted" : made.error().message;
  }
  std::vector<DecodedJoint> read(JointReader& reader, const std::string& message,
                                 const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX()) const {
    std::vector<DecodedJoint> joints;
    EXPECT_TRUE(reader.read(as_span(message), axis, joints));
    return joints;
  }
};
INSTANTIATE_TEST_SUITE_P(Ros1AndRos2, JointsByDefinition,
                         testing::Values(MessageBytes::kRos1, MessageBytes::kCdr,
                                         MessageBytes::kCdrBigEndian));

TEST_P(JointsByDefinition, AFieldIsFoundByItsNameAndIndex) {
  auto third = reader(topic("my_msgs/State", kState), "position[2]");
  ASSERT_TRUE(third) << third.error().message;
  auto joints = read(*third, state());
  ASSERT_EQ(joints.size(), 1U);
  EXPECT_EQ(joints[0].name, "position[2]");
  EXPECT_EQ(joints[0].position, -2.5);
  EXPECT_EQ(joints[0].header_ns, 7'000'000'008);
  auto ticks = reader(topic("my_msgs/State", kState), "encoders[1].ticks");
  ASSERT_TRUE(ticks) << ticks.error().message;
  EXPECT_EQ(read(*ticks, state()).at(0).position, -50);
  EXPECT_EQ(ticks->kind(), MessageKind::kFields);
}

TEST_P(JointsByDefinition, AnArrayHasAJointPerElement) {
  auto all = reader(topic("my_msgs/State", kState), "position");
  ASSERT_TRUE(all) << all.error().message;
  const auto joints = read(*all, state());
  ASSERT_EQ(joints.size(), 3U);
  EXPECT_EQ(joints[1].name, "position[1]");
  EXPECT_EQ(joints[1].position, 1.5);
}

TEST_P(JointsByDefinition, AnIndexBehindTheEndOfAnArrayIsNoSample) {
  auto tenth = reader(topic("my_msgs/State", kState), "position[9]");
  ASSERT_TRUE(tenth);
  EXPECT_TRUE(read(*tenth, state()).empty());
}

TEST_P(JointsByDefinition, EveryCutOfAMessageIsMalformed) {
  auto third = reader(topic("my_msgs/State", kState), "position[2]");
  ASSERT_TRUE(third);
  const std::string whole = state();
  std::vector<DecodedJoint> joints;
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_FALSE(third->read(as_span(whole).first(n), Eigen::Vector3d::UnitX(), joints)) << n;
  EXPECT_FALSE(third->read(as_span(whole + std::string(4, '\0')), Eigen::Vector3d::UnitX(), joints));
}

TEST_P(JointsByDefinition, SeveralNumbersAreListedAndOneIsAskedFor) {
  EXPECT_EQ(
      refusal(topic("my_msgs/State", kState)),
      "topic /state (my_msgs/State) has several numbers. Name one in a rig file (motor: {topic: /state, "
      "field: position[0]}, given with --rig). Its numbers: status, position[0], encoders[0].on, "
      "encoders[0].ticks");
  EXPECT_EQ(
      refusal(topic("my_msgs/State", kState), "angle"),
      "topic /state (my_msgs/State) has no number \"angle\", the rig's motor.field. Its numbers: status, "
      "position[0], encoders[0].on, encoders[0].ticks");
  for (const char* other : {"text", "status[0]", "position[", "position[x]", "encoders", "header.stamp", ""})
    EXPECT_NE(refusal(topic("my_msgs/State", kState), other).find("has no number"), std::string::npos)
        << other;
}

TEST_P(JointsByDefinition, TheOnlyNumberNeedsNoName) {
  const std::string definition = "std_msgs/Header header\nint16 ticks\n";
  auto only = reader(topic("my_msgs/Pulses", definition));
  ASSERT_TRUE(only) << only.error().message;
  const auto joints = read(*only, MessageBytes(GetParam()).header(1, 2, "").number(std::int16_t{-7}).bytes());
  EXPECT_EQ(joints.at(0).name, "ticks");
  EXPECT_EQ(joints.at(0).position, -7);
}

template <typename T>
void expect_number(JointReader reader, MessageBytes::Form form, T value) {
  std::vector<DecodedJoint> joints;
  ASSERT_TRUE(
      reader.read(as_span(MessageBytes(form).number(value).bytes()), Eigen::Vector3d::UnitX(), joints));
  EXPECT_EQ(joints.at(0).position, static_cast<double>(value));
}

TEST_P(JointsByDefinition, EveryNumberOfStdMsgsIsKnownWithoutADefinition) {
  const auto of = [&](const char* type) { return reader(topic(std::string("std_msgs/") + type)).value(); };
  expect_number(of("Int8"), GetParam(), std::int8_t{-3});
  expect_number(of("UInt8"), GetParam(), std::uint8_t{200});
  expect_number(of("Int16"), GetParam(), std::int16_t{-300});
  expect_number(of("UInt16"), GetParam(), std::uint16_t{60000});
  expect_number(of("Int32"), GetParam(), std::int32_t{-70000});
  expect_number(of("UInt32"), GetParam(), std::uint32_t{4000000000});
  expect_number(of("Int64"), GetParam(), std::int64_t{-5000000000});
  expect_number(of("UInt64"), GetParam(), std::uint64_t{5000000000});
  expect_number(of("Float32"), GetParam(), 1.5F);
  expect_number(of("Float64"), GetParam(), -2.25);
  EXPECT_EQ(of("Int8").kind(), MessageKind::kFieldsWithoutHeader);
  EXPECT_NE(refusal(topic("std_msgs/String")).find("does not hold the definition of std_msgs/String"),
            std::string::npos);
}

TEST_P(JointsByDefinition, AnArrayOfStdMsgsHasAJointPerElement) {
  const std::string message = MessageBytes(GetParam())
                                  .number(std::uint32_t{1})
                                  .text("angles")
                                  .number(std::uint32_t{2})
                                  .number(std::uint32_t{2})
                                  .number(std::uint32_t{0})
                                  .array(std::vector<std::uint16_t>{11, 12})
                                  .bytes();
  auto all = reader(topic("std_msgs/UInt16MultiArray"));
  ASSERT_TRUE(all) << all.error().message;
  const auto joints = read(*all, message);
  ASSERT_EQ(joints.size(), 2U);
  EXPECT_EQ(joints[1].name, "data[1]");
  auto second = reader(topic("std_msgs/UInt16MultiArray"), "data[1]");
  ASSERT_TRUE(second);
  EXPECT_EQ(read(*second, message).at(0).position, 12);
}

TEST_P(JointsByDefinition, ARotationIsItsAngleAboutTheAxis) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.7, axis));
  MessageBytes quaternion(GetParam()), pose(GetParam());
  quaternion.header(3, 4, "base");
  pose.header(3, 4, "base").number(1.0).number(2.0).number(3.0);
  for (MessageBytes* message : {&quaternion, &pose})
    message->number(rotation.x()).number(rotation.y()).number(rotation.z()).number(rotation.w());
  auto of_quaternion = reader(topic("geometry_msgs/QuaternionStamped"));
  auto of_pose = reader(topic("geometry_msgs/PoseStamped"));
  ASSERT_TRUE(of_quaternion && of_pose);
  EXPECT_NEAR(read(*of_quaternion, quaternion.bytes(), axis).at(0).position, 0.7, 1e-15);
  EXPECT_NEAR(read(*of_pose, pose.bytes(), axis).at(0).position, 0.7, 1e-15);
}

TEST_P(JointsByDefinition, AVectorAsksForOneOfItsNumbers) {
  EXPECT_NE(refusal(topic("geometry_msgs/Vector3Stamped")).find("Its numbers: vector.x, vector.y, vector.z"),
            std::string::npos);
  auto point = reader(topic("geometry_msgs/PointStamped"), "point.z");
  ASSERT_TRUE(point) << point.error().message;
  const std::string message =
      MessageBytes(GetParam()).header(1, 2, "base").number(1.0).number(2.0).number(3.0).bytes();
  EXPECT_EQ(read(*point, message).at(0).position, 3);
}

TEST_P(JointsByDefinition, AControllersStateIsItsMeasuredValue) {
  MessageBytes message(GetParam());
  message.header(1, 2, "");
  for (const double value : {0.9, 0.75, 0., 0., 0., 0., 0., 0., 0., 0.}) message.number(value);
  auto controller = reader(topic("control_msgs/JointControllerState"));
  ASSERT_TRUE(controller) << controller.error().message;
  EXPECT_EQ(read(*controller, message.number(std::uint8_t{0}).bytes()).at(0).position, 0.75);
  EXPECT_EQ(controller->source(), JointSource::kController);
}

TEST_P(JointsByDefinition, ATrajectoryControllersJointsHaveTheirNames) {
  const std::string point =
      "================\nMSG: trajectory_msgs/JointTrajectoryPoint\nfloat64[] positions\n";
  for (const char* measured : {"actual", "feedback"}) {
    const std::string members = std::string("Header header\nstring[] joint_names\n") +
                                "trajectory_msgs/JointTrajectoryPoint desired\n" +
                                "trajectory_msgs/JointTrajectoryPoint " + measured + "\n";
    auto controller = reader(topic("control_msgs/JointTrajectoryControllerState", members + point));
    ASSERT_TRUE(controller) << controller.error().message;
    MessageBytes message(GetParam());
    message.header(1, 2, "").number(std::uint32_t{2}).text("pan").text("tilt");
    message.array(std::vector<double>{9, 9}).array(std::vector<double>{0.25, 0.5});
    const std::string bytes = message.bytes();
    const auto joints = read(*controller, bytes);
    ASSERT_EQ(joints.size(), 2U);
    EXPECT_EQ(joints[1].name, "tilt");
    EXPECT_EQ(joints[1].position, 0.5);
  }
}

// As in a .db3, which holds no definitions; the versions of the message differ in what follows "actual".
TEST_P(JointsByDefinition, ATrajectoryControllersStateNeedsNoDefinition) {
  auto controller = reader(topic("control_msgs/JointTrajectoryControllerState"));
  ASSERT_TRUE(controller) << controller.error().message;
  MessageBytes message(GetParam());
  message.header(1, 2, "").number(std::uint32_t{2}).text("pan").text("tilt");
  for (const double position : {9., 0.25, 8.}) {
    message.array(std::vector<double>{position, 2 * position});
    for (int i = 0; i < 3; ++i) message.array(std::vector<double>{7, 7});
    message.number(std::uint32_t{0}).number(std::uint32_t{0});
  }
  const std::string bytes = message.bytes();
  const auto joints = read(*controller, bytes);
  ASSERT_EQ(joints.size(), 2U);
  EXPECT_EQ(joints[1].name, "tilt");
  EXPECT_EQ(joints[1].position, 0.5);
}

TEST_P(JointsByDefinition, AListOfDynamixelsHasAJointPerServo) {
  const std::string definition =
      "DynamixelState[] dynamixel_state\n====\nMSG: dynamixel_workbench_msgs/DynamixelState\n"
      "string name\nuint8 id\nint32 present_position\nint32 present_velocity\nint16 present_current\n";
  for (const std::string& given : {definition, std::string()}) {
    auto list = reader(topic("dynamixel_workbench_msgs/DynamixelStateList", given));
    ASSERT_TRUE(list) << list.error().message;
    MessageBytes message(GetParam());
    message.number(std::uint32_t{2});
    for (const std::int32_t position : {2048, 1024})
      message.text(position == 2048 ? "pan" : "tilt")
          .number(std::uint8_t{1})
          .number(position)
          .number(std::int32_t{0})
          .number(std::int16_t{0});
    const std::string bytes = message.bytes();
    const auto joints = read(*list, bytes);
    ASSERT_EQ(joints.size(), 2U);
    EXPECT_EQ(joints[1].name, "tilt");
    EXPECT_EQ(joints[1].position, 1024);
  }
}

TEST_P(JointsByDefinition, ATypeThatCannotBeReadIsRefusedWithTheReason) {
  EXPECT_EQ(refusal(topic("my_msgs/State")),
            "topic /state (my_msgs/State) cannot be read: the recording does not hold the definition of "
            "my_msgs/State; convert it to MCAP with `ros2 bag convert` on a computer that has the package of "
            "this message");
  EXPECT_NE(refusal(topic("my_msgs/State", "Part part\nint8 a\n")).find("the definition of my_msgs/Part"),
            std::string::npos);
  EXPECT_NE(refusal(topic("my_msgs/A", "B b\n===\nMSG: my_msgs/B\nA a\n===\nMSG: my_msgs/A\nB b\n"))
                .find("contains itself"),
            std::string::npos);
  EXPECT_NE(refusal(topic("my_msgs/A", "wstring text\nint8 a\n")).find("holds a wstring"), std::string::npos);
  EXPECT_NE(refusal(topic("my_msgs/A", "int8\n")).find("is damaged at \"int8\""), std::string::npos);
  EXPECT_NE(refusal(topic("my_msgs/A", "string text\n")).find("holds no numbers"), std::string::npos);
}

TEST_P(JointsByDefinition, CountsThatTheMessageDoesNotHoldAllocateNothing) {
  const std::string definition =
      "Part[] parts\nfloat64[4294967295] much\nint8 last\n===\nMSG: my_msgs/Part\nPart2[4000000000] "
      "p\n===\nMSG: my_msgs/Part2\nstring name\n";
  auto last = reader(topic("my_msgs/A", definition), "last");
  ASSERT_TRUE(last) << last.error().message;
  const std::string bytes = MessageBytes(GetParam()).number(std::uint32_t{0xFFFFFFFF}).fill(64).bytes();
  std::vector<DecodedJoint> joints;
  EXPECT_FALSE(last->read(as_span(bytes), Eigen::Vector3d::UnitX(), joints));
}

}  // namespace
}  // namespace sweepscope
