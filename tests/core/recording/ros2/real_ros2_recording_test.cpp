#include "core/offset/estimator.hpp"
#include "core/offset/summary.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/inspect.hpp"
#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

/// An RPLIDAR C1 tilted by a hobby servo; see the README beside it.
class LidarServo : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path data = test::real_data();
    if (data.empty()) GTEST_SKIP() << "no real recordings: set SWEEPSCOPE_REAL_DATA to their folder";
    bag_ = data / "rosbag2_lidar_servo/lidarServo";
    const auto rig = read_rig(std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "assets/rigs/lidar_servo.yaml");
    ASSERT_TRUE(rig) << rig.error().message;
    options_.rig = *rig;
  }
  Recording read(const std::filesystem::path& path) const {
    auto recording = read_recording(path, options_, Job());
    EXPECT_TRUE(recording) << recording.error().message;
    return recording ? *recording : Recording();
  }

  std::filesystem::path bag_;
  ReadOptions options_;
};

TEST_F(LidarServo, HoldsWhatItIsKnownToHoldAsFolderAndAsFile) {
  for (const auto& path : {bag_, bag_ / "lidarServo_0.db3"}) {
    const Recording recording = read(path);
    ASSERT_EQ(recording.scans.size(), 295U);
    EXPECT_EQ(recording.report.scans_dropped, 3U);  // these have no beams
    EXPECT_EQ(recording.motor.time_s.size() + recording.report.motor_repeated, 1372U);
    EXPECT_LT(recording.report.motor_repeated, 20U) << "old angles that later ones overtook";
    EXPECT_EQ(recording.name, path.filename());
    EXPECT_EQ(recording.report.topics.at(0).type, "std_msgs/msg/Int32");
    EXPECT_EQ(recording.report.topics.at(1).type, "sensor_msgs/msg/LaserScan");
    EXPECT_EQ(recording.rig.motor.joint, "data");
  }
}

TEST_F(LidarServo, ItsFaultsAreTold) {
  const Recording recording = read(bag_);
  const RecordingSummary summary = inspect(recording);
  EXPECT_NEAR(summary.motor.min_deg, 60 - 90, 1e-9);
  EXPECT_NEAR(summary.motor.max_deg, 119 - 90, 1e-9);
  EXPECT_GT(summary.laser.gaps, 0U);
  EXPECT_NEAR(summary.laser.longest_gap_s, 11.8, 0.3);
  EXPECT_NEAR(double(summary.laser.zero) / double(summary.laser.beams), 0.25, 0.08);
  EXPECT_GT(*summary.laser.receive_jitter_s, 0.02);
  std::string warnings;
  for (const std::string& warning : summary.warnings) warnings += warning + "\n";
  EXPECT_NE(warnings.find("/lidar_servo_angle holds plain numbers"), std::string::npos) << warnings;
  EXPECT_EQ(summary.laser.stamp_at, StampAt::kLastBeam);
  std::string expectations;
  for (const std::string& line : sweepscope::expectations(recording, summary, find_sweeps(recording.motor)))
    expectations += line + "\n";
  EXPECT_NE(expectations.find("Expect a refusal: the scans' receive times are uneven"), std::string::npos)
      << expectations;
  EXPECT_EQ(expectations.find("Expect an accuracy"), std::string::npos) << expectations;
  EXPECT_NE(warnings.find("have no time_increment; scan_time / beams is used"), std::string::npos)
      << warnings;
}

TEST_F(LidarServo, NoMethodAnswersForIt) {
  const Recording recording = read(bag_);
  for (const auto method : {std::optional<Method>(), std::optional(Method::kStationary),
                            std::optional(Method::kMoving), std::optional(Method::kDirect)}) {
    EstimateOptions options;
    options.method = method;
    const auto answer = estimate(recording, options, Job());
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_FALSE(answer->identifiable);
    EXPECT_FALSE(answer->offset_s);
    ASSERT_EQ(answer->reasons().size(), 1U);
    EXPECT_EQ(answer->reasons()[0].rfind("The scans' receive times are uneven", 0), 0U)
        << answer->reasons()[0];
  }
}

TEST_F(LidarServo, WithoutARigItIsReadWithTheServosDegreesInDoubt) {
  options_.rig.reset();
  const Recording recording = read(bag_);
  EXPECT_EQ(recording.scans.size(), 295U);
  EXPECT_EQ(recording.report.motor_stamps.used, StampSource::kReceive);
  std::string warnings;
  for (const std::string& warning : recording.report.warnings) warnings += warning + "\n";
  EXPECT_NE(warnings.find("multiplied by 1 (the rig's motor.scale and motor.unit) to give rad"),
            std::string::npos)
      << warnings;
  EXPECT_NE(warnings.find("the laser uses header stamps and the motor receive times"), std::string::npos)
      << warnings;
}

}  // namespace
}  // namespace sweepscope
