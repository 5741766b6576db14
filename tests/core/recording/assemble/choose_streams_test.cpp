#include "core/recording/assemble/choose_streams.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

RawRecording with_lasers(const std::vector<std::string>& topics) {
  RawRecording raw;
  raw.file = "a.bag";
  for (const std::string& topic : topics) {
    raw.topics.push_back({topic, "sensor_msgs/LaserScan", 1, 0});
    RawLaser& laser = raw.lasers.emplace_back();
    laser.topic = topic;
    laser.scans.resize(1);
  }
  return raw;
}

/// Joints of /joints, each between 0 and so many radians.
RawRecording with_joints(const std::vector<std::pair<std::string, double>>& joints) {
  RawRecording raw;
  raw.file = "a.bag";
  raw.topics.push_back({"/joints", "sensor_msgs/JointState", 10, 0});
  for (const auto& [name, turn_rad] : joints) {
    RawJoint& joint = raw.joints.emplace_back();
    joint.topic = "/joints";
    joint.joint = name;
    joint.positions = {0, NAN, turn_rad};
    joint.stamps.resize(3);
  }
  return raw;
}

template <typename T>
std::string refusal(const Result<T>& result) {
  return result ? "accepted" : result.error().message;
}

TEST(ChooseLaser, TakesTheOnlyOneOrTheOneThatTheRigNames) {
  EXPECT_EQ(choose_laser(with_lasers({"/scan"}), {}), 0U);
  Rig rig;
  rig.laser.topic = "/b";
  EXPECT_EQ(choose_laser(with_lasers({"/a", "/b"}), rig), 1U);
}

TEST(ChooseLaser, ScansOfOneEchoComeBeforeThoseOfSeveral) {
  RawRecording raw = with_lasers({"/echoes", "/scan"});
  raw.lasers[0].of_echoes = true;
  EXPECT_EQ(choose_laser(raw, {}), 1U);
  raw.lasers.pop_back();
  EXPECT_EQ(choose_laser(raw, {}), 0U);
}

TEST(ChooseLaser, RefusesSeveralAndListsThem) {
  EXPECT_EQ(refusal(choose_laser(with_lasers({"/a", "/b"}), {})),
            "a.bag: 2 topics of scans, and it is ambiguous which to use; name one in a rig file (laser: "
            "{topic: /a}, given with --rig):\n    /a   sensor_msgs/LaserScan   1 messages\n    /b   "
            "sensor_msgs/LaserScan   1 messages");
}

TEST(ChooseLaser, RefusesATopicThatIsNotThereAndListsTheOthers) {
  Rig rig;
  rig.laser.topic = "/c";
  EXPECT_EQ(refusal(choose_laser(with_lasers({"/a"}), rig)),
            "a.bag: no usable scans on /c, the rig's laser.topic. Topics of scans found:\n"
            "    /a   sensor_msgs/LaserScan   1 messages");
}

TEST(ChooseLaser, NamesTheDamageThatMayBeWhyATopicIsMissing) {
  RawRecording raw = with_lasers({"/a"});
  raw.warnings.push_back("it is cut short");
  Rig rig;
  rig.laser.topic = "/c";
  EXPECT_TRUE(refusal(choose_laser(raw, rig)).ends_with("\n  also: it is cut short"));
}

TEST(ChooseLaser, SaysWhatIsThereWhereThereAreNoScans) {
  RawRecording raw;
  raw.file = "a.bag";
  raw.topics.push_back({"/tf", "tf2_msgs/TFMessage", 3, 0});
  EXPECT_EQ(refusal(choose_laser(raw, {})),
            "a.bag: no sensor_msgs/LaserScan. Topics found:\n    /tf   tf2_msgs/TFMessage   3 messages");
}

TEST(ChooseJoint, TakesTheOnlyOneThatMoves) {
  EXPECT_EQ(choose_joint(with_joints({{"arm", 0.001}, {"roll", 3}, {"grip", 0}}), {}), 1U);
}

TEST(ChooseJoint, TakesAStuckMotorWhereItIsTheOnlyJoint) {
  EXPECT_EQ(choose_joint(with_joints({{"roll", 0}}), {}), 0U);
}

TEST(ChooseJoint, TheRigsScaleDecidesWhatMoves) {
  Rig rig;
  rig.motor.scale = 0.001;  // ticks
  EXPECT_EQ(choose_joint(with_joints({{"idle", 3}, {"roll", 3000}}), rig), 1U);
}

TEST(ChooseJoint, RefusesSeveralThatMoveAndListsThem) {
  EXPECT_EQ(refusal(choose_joint(with_joints({{"roll", 3.0}, {"idle", 0}, {"left_wheel", 9.0}}), {})),
            "a.bag: 2 of 3 joints move, and it is ambiguous which of them turns the scanner; name it in a "
            "rig file (motor: {topic: /joints, joint: roll}, given with --rig):\n"
            "    roll         turns over 171.9 deg   3 samples   on /joints\n"
            "    left_wheel   turns over 515.7 deg   3 samples   on /joints");
}

TEST(ChooseJoint, RefusesSeveralThatAllStandStill) {
  EXPECT_NE(refusal(choose_joint(with_joints({{"a", 0}, {"b", 0}}), {})).find("a.bag: 0 of 2 joints move"),
            std::string::npos);
}

TEST(ChooseJoint, OneNameOnTwoTopicsIsToldApartByTheTopic) {
  RawRecording raw = with_joints({{"roll", 3}, {"roll", 3}});
  raw.joints[1].topic = "/motor";
  Rig rig;
  rig.motor.joint = "roll";
  EXPECT_NE(refusal(choose_joint(raw, rig)).find("2 of 2 joints move"), std::string::npos);
  rig.motor.topic = "/motor";
  EXPECT_EQ(choose_joint(raw, rig), 1U);
}

TEST(ChooseJoint, RefusesAJointThatIsNotThereAndListsTheOthers) {
  Rig rig;
  rig.motor.joint = "pitch";
  EXPECT_EQ(refusal(choose_joint(with_joints({{"roll", 3}}), rig)),
            "a.bag: no positions of joint pitch on topic (any), which the rig names. Joints found:\n"
            "    roll   turns over 171.9 deg   3 samples   on /joints");
}

TEST(ChooseJoint, SaysWhatIsThereWhereThereAreNoJoints) {
  EXPECT_EQ(
      refusal(choose_joint(with_lasers({"/scan"}), {})),
      "a.bag: no sensor_msgs/JointState. Topics found:\n    /scan   sensor_msgs/LaserScan   "
      "1 messages\n  If nothing measures it, state how the motor is driven in a rig file (motor: {profile: ...}).");
}

TEST(ChooseJoint, JointStatesComeBeforeNumbersAndThoseBeforeTransforms) {
  RawRecording raw = with_joints({{"frame", 1}, {"data", 1}, {"roll", 1}});
  raw.joints[0].source = JointSource::kTransform;
  raw.joints[0].topic = "/tf";
  raw.joints[1].source = JointSource::kNumber;
  EXPECT_EQ(choose_joint(raw, Rig()).value(), 2U);
  Rig rig;
  rig.motor.topic = "/tf";
  EXPECT_EQ(choose_joint(raw, rig).value(), 0U);
  raw.joints.pop_back();
  EXPECT_EQ(choose_joint(raw, Rig()).value(), 1U);
  raw.joints.pop_back();
  EXPECT_EQ(choose_joint(raw, Rig()).value(), 0U);
}

TEST(ChooseJoint, AControllersStateComesBeforeANumberThatMayBeItsCommand) {
  RawRecording raw = with_joints({{"data", 1}, {"process_value", 1}});
  raw.joints[0].source = JointSource::kNumber;
  raw.joints[1].source = JointSource::kController;
  EXPECT_EQ(choose_joint(raw, Rig()).value(), 1U);
}

TEST(ChooseJoint, AMotorThatStandsIsNotReplacedByATransformThatMoves) {
  RawRecording raw = with_joints({{"base", 1}, {"roll", 0}});
  raw.joints[0].source = JointSource::kTransform;
  EXPECT_EQ(choose_joint(raw, Rig()).value(), 1U);
}

}  // namespace
}  // namespace sweepscope
