#include "core/recording/survey/survey.hpp"

#include <gtest/gtest.h>

#include "core/recording/rig/named_streams.hpp"

namespace sweepscope {
namespace {

RawLaser laser(const std::string& topic, std::uint32_t beams) {
  RawLaser made;
  made.topic = topic;
  for (int i = 0; i < 11; ++i) {
    RawScan scan;
    scan.stamps = {1'000'000'000 + i * 25'000'000, 0};
    scan.beams = beams;
    made.scans.push_back(scan);
  }
  return made;
}

RawJoint joint(const std::string& topic, const std::string& name, double turned_rad) {
  RawJoint made;
  made.topic = topic;
  made.joint = name;
  made.positions = {0, turned_rad, turned_rad / 2};
  made.stamps.resize(3);
  return made;
}

RawRecording recording(std::vector<RawLaser> lasers, std::vector<RawJoint> joints) {
  RawRecording raw;
  raw.file = "a.bag";
  raw.lasers = std::move(lasers);
  raw.joints = std::move(joints);
  raw.topics = {{"/front", "sensor_msgs/LaserScan", 11, 0}, {"/odom", "nav_msgs/Odometry", 5, 0}};
  return raw;
}

TEST(Survey, ListsWhatCanBeChosenAndWhatIsDetected) {
  const RecordingSurvey found = survey(
      recording({laser("/front", 721)}, {joint("/joints", "wheel", 0), joint("/joints", "roll", 3)}), {});
  EXPECT_EQ(found.lasers, (std::vector{LaserChoice{"/front", false, 11, 721, 40}}));
  ASSERT_EQ(found.joints.size(), 2U);
  EXPECT_NEAR(found.joints[1].turned_deg, 171.9, 0.1);
  EXPECT_EQ(found.laser, 0U);
  EXPECT_EQ(found.joint, 1U);
  EXPECT_TRUE(found.complete());
  EXPECT_EQ(found.laser_problem + found.joint_problem, "");
  EXPECT_TRUE(found.header_stamps);
  EXPECT_FALSE(found.receive_stamps);
}

TEST(Survey, SaysWhatIsAmbiguous) {
  const RecordingSurvey found = survey(recording({laser("/front", 721), laser("/back", 100)},
                                                 {joint("/joints", "wheel", 9), joint("/joints", "roll", 3)}),
                                       {});
  EXPECT_FALSE(found.complete());
  EXPECT_EQ(found.laser_problem, "2 topics hold scans. Choose the scanner that the motor turns.");
  EXPECT_EQ(found.joint_problem, "2 of 2 joints turn. Choose the one that turns the scanner.");
}

TEST(Survey, TakesWhatIsNamed) {
  const RawRecording raw = recording({laser("/front", 721), laser("/back", 100)},
                                     {joint("/joints", "wheel", 9), joint("/joints", "roll", 3)});
  Rig rig;
  rig.laser.topic = "/front";
  rig.motor.topic = "/nowhere";
  const RecordingSurvey found = survey(raw, with_streams(rig, {"/back", std::nullopt, "roll"}));
  EXPECT_EQ(found.laser, 1U);
  EXPECT_EQ(found.joint, 1U);
  EXPECT_EQ(survey(raw, with_streams({}, {"/side", {}, "roll"})).laser_problem,
            "There are no scans on /side.");
  EXPECT_EQ(survey(raw, with_streams({}, {"/back", {}, "yaw"})).joint_problem,
            "There is no joint yaw on any topic.");
}

TEST(Survey, SaysWhatTheFileHoldsInsteadOfAMotor) {
  const RecordingSurvey found = survey(recording({laser("/front", 721)}, {}), {});
  EXPECT_EQ(found.laser, 0U);
  EXPECT_EQ(found.joint_problem,
            "No topic holds the angle of a motor: joint states, numbers or transforms. Topics: /front "
            "(LaserScan), /odom (Odometry).");
}

TEST(Survey, SaysWhyATopicThatLooksRightIsNotUsed) {
  RawRecording raw = recording({laser("/front", 721)}, {});
  raw.warnings = {"a.bag: topic /joints holds another version of sensor_msgs/JointState and is not used"};
  EXPECT_EQ(survey(raw, {}).joint_problem,
            "No topic holds the angle of a motor: joint states, numbers or transforms. Topics: /front "
            "(LaserScan), /odom (Odometry). Also: a.bag: topic /joints holds another version of "
            "sensor_msgs/JointState and is not used.");
}

TEST(Survey, ReadsEveryStreamWhateverTheRigNames) {
  Rig rig;
  rig.laser.topic = "/front";
  rig.motor.joint = "roll";
  rig.motor.scale = 0.5;
  const Rig all = without_streams(rig);
  EXPECT_FALSE(all.laser.topic || all.motor.topic || all.motor.joint);
  EXPECT_EQ(all.motor.scale, 0.5);
}

TEST(NamedStreams, ANamedTopicOrJointReplacesTheRigsPair) {
  Rig rig;
  rig.motor.topic = "/a";
  rig.motor.joint = "roll";
  EXPECT_EQ(with_streams(rig, {}).motor.topic, "/a");
  EXPECT_EQ(with_streams(rig, {{}, {}, "yaw"}).motor.topic, std::nullopt);
  EXPECT_EQ(with_streams(rig, {{}, "/b", {}}).motor.joint, std::nullopt);
  EXPECT_EQ(with_streams(rig, {{}, "/b", "yaw"}).motor.joint, "yaw");
}

}  // namespace
}  // namespace sweepscope
