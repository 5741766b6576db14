#include "core/recording/formats/read_recording.hpp"
#include "core/recording/inspect.hpp"
#include "core/recording/sweeps.hpp"
#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

/// A URG-04LX tilted by a Dynamixel on a robot whose wheels are in the same topic; see the README beside it.
class GuardianTilt : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path data = test::real_data();
    bag_ = data / "guardian_tilt/guardian_tilt_B.bag";
    if (data.empty()) GTEST_SKIP() << "no real recordings: set SWEEPSCOPE_REAL_DATA to their folder";
    const auto rig =
        read_rig(std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "assets/rigs/guardian_tilt.yaml");
    ASSERT_TRUE(rig) << rig.error().message;
    options_.rig = *rig;
  }
  Recording read() const {
    auto recording = read_recording(bag_, options_, Job());
    EXPECT_TRUE(recording) << recording.error().message;
    return recording ? *recording : Recording();
  }

  std::filesystem::path bag_;
  ReadOptions options_;
};

TEST_F(GuardianTilt, HoldsTheScansAndSamplesThatItIsKnownToHold) {
  const Recording recording = read();
  ASSERT_EQ(recording.scans.size(), 421U);
  EXPECT_EQ(recording.motor.time_s.size(), 2105U);
  EXPECT_TRUE(recording.intensities.empty());
  EXPECT_TRUE(recording.report.warnings.empty());
  for (const LaserScan& scan : recording.scans) ASSERT_EQ(scan.beams, 681U);
  const LaserScan& scan = recording.scans.front();
  EXPECT_NEAR(scan.time_increment_s, 9.7656e-5, 1e-9);
  EXPECT_NEAR(scan.beam_angle_rad(0), -2.0862, 1e-4);
  EXPECT_NEAR(scan.beam_angle_rad(680), 2.0862, 1e-4);
  EXPECT_NEAR(420 / (recording.scans.back().first_beam_s - scan.first_beam_s), 9.98, 0.03);
}

TEST_F(GuardianTilt, MotorTurnsAsItIsKnownTo) {
  const RecordingSummary summary = inspect(read());
  EXPECT_NEAR(summary.motor.min_deg, -0.505 * 57.2958, 0.1);
  EXPECT_NEAR(summary.motor.max_deg, 1.002 * 57.2958, 0.1);
  EXPECT_NEAR(summary.motor.median_speed_deg_s, 18.9, 0.3);
  EXPECT_NEAR(summary.motor.rate_hz(), 50, 0.1);
  EXPECT_NEAR(2 * summary.motor.median_sweep_s, 9.64, 0.05);
  EXPECT_EQ(summary.topics.size(), 16U);
}

TEST_F(GuardianTilt, StandingPartHasTwoReversals) {
  const Recording recording = read();
  const Recording standing = window(recording, 0, 13);
  const std::vector<Sweep> sweeps = find_sweeps(standing.motor).sweeps;
  ASSERT_EQ(sweeps.size(), 3U);  // part of one, a whole one, part of one
  const double start_s = recording.scans.front().first_beam_s;
  EXPECT_NEAR(sweeps[1].begin_s - start_s, 6.8, 0.15);
  EXPECT_NEAR(sweeps[1].end_s - start_s, 11.7, 0.15);
}

TEST_F(GuardianTilt, ReceiveTimesOfScansLagThoseOfTheMotorBy95Point7Milliseconds) {
  const RecordingSummary summary = inspect(read());
  EXPECT_NEAR(*summary.laser.receive_minus_header_s, -7.55, 0.01);
  EXPECT_NEAR(*summary.laser.receive_minus_header_s - *summary.motor.receive_minus_header_s, 0.0957, 0.0005);
  EXPECT_NEAR(*summary.laser.receive_jitter_s, 0.0006, 0.0003);
}

// Two scanners and five joints that move: the transforms show which of them belong together.
TEST_F(GuardianTilt, WithoutARigItsTransformsShowWhatTurnsTheScanner) {
  const auto given = read_recording(bag_, options_, Job()), found = read_recording(bag_, {}, Job());
  ASSERT_TRUE(given);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->rig.laser.topic, given->rig.laser.topic);
  EXPECT_EQ(found->rig.motor.joint, "laser_tilt_joint");
  EXPECT_LT((found->rig.mount.axis - given->rig.mount.axis).norm(), 1e-6);
  EXPECT_LT((found->rig.mount.laser_in_motor_xyz_m - given->rig.mount.laser_in_motor_xyz_m).norm(), 1e-4);
  EXPECT_TRUE(std::ranges::any_of(found->report.warnings, [](const std::string& warning) {
    return warning.find("that of the recording's transforms") != std::string::npos;
  }));
}

TEST_F(GuardianTilt, CutAnywhereItNeverDoesWorseThanARefusal) {
  const test::ScratchFolder folder;
  const std::string whole = test::contents_of(bag_);
  for (std::size_t bytes = 1; bytes < whole.size(); bytes += whole.size() / 12) {
    test::write_file(folder / "cut.bag", whole.substr(0, bytes));
    const auto recording = read_recording(folder / "cut.bag", options_, Job());
    if (recording) {
      EXPECT_FALSE(recording->report.warnings.empty()) << "cut at " << bytes;
    } else {
      EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput) << "cut at " << bytes;
    }
  }
}

}  // namespace
}  // namespace sweepscope
