// A moving rig's offset with a trajectory from elsewhere: as a prior, as the truth, and where it makes no
// sense.
#include <gtest/gtest.h>

#include "core/offset/estimator.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kShift_s = 0.137;  // added to the poses' stamps it gives the laser's clock

const Simulation& walk() {
  static const Simulation made = [] {
    SimulationOptions options;
    options.scene = "metro-station";
    options.duration_s = 26;
    options.imu = true;
    options.imu_shift_s = kShift_s;
    return simulate(options, Job()).value();
  }();
  return made;
}

std::vector<StampedPose> true_poses(double shift_s) {
  std::vector<StampedPose> poses;
  for (const TruthPose& pose : walk().truth)
    poses.push_back({pose.time_s - shift_s, pose.position_m, pose.orientation});
  return poses;
}

Result<Estimate> estimated_with(const Recording& recording, std::optional<GivenPoses> poses) {
  EstimateOptions options;
  options.method = Method::kDirect;
  options.poses = std::move(poses);
  return estimate(recording, options, Job());
}

void expect_found(const Result<Estimate>& found, double offset_tolerance_s, double shift_tolerance_s) {
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(found->identifiable) << found->reasons().front();
  EXPECT_NEAR(*found->offset_s, 0.024, offset_tolerance_s);
  EXPECT_NEAR(*found->offset_s, 0.024, 4 * *found->sigma_s);
  ASSERT_TRUE(found->motion);
  EXPECT_NEAR(found->motion->time_shift_s.value_or(0), kShift_s, shift_tolerance_s);
  EXPECT_NEAR(found->motion->time_shift_s.value_or(0), kShift_s,
              4 * found->motion->time_shift_sigma_s.value_or(0));
}

TEST(GivenPoses, AsThePriorAreHelpAndTheirTimeShiftIsFound) {
  const auto found = estimated_with(walk().recording, GivenPoses{"T.tum", true_poses(kShift_s), false});
  expect_found(found, 0.1 * kMs, 2 * kMs);
  EXPECT_EQ(found->motion->name, "T.tum");
  EXPECT_FALSE(found->motion->trusted);
}

TEST(GivenPoses, AsTheTruthGiveTheOffsetToHundredthsOfAMillisecond) {
  const auto found = estimated_with(walk().recording, GivenPoses{"T.tum", true_poses(kShift_s), true});
  expect_found(found, 0.03 * kMs, 0.5 * kMs);
  EXPECT_TRUE(found->motion->trusted);
  EXPECT_LT(*found->sigma_s, 0.05 * kMs);
}

TEST(GivenPoses, AreFoundAtAnEpochOfAnotherClock) {
  auto poses = true_poses(1000 + kShift_s);
  const auto found = estimated_with(walk().recording, GivenPoses{"T.tum", std::move(poses), true});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found->motion->time_shift_s.value_or(0), 1000 + kShift_s, 1 * kMs);
  EXPECT_NEAR(found->offset_s.value_or(0), 0.024, 0.03 * kMs);
}

TEST(GivenPoses, OfTheRigsImuAreAPriorWithATimeShiftOfItsOwn) {
  Recording recording = walk().recording;
  recording.rig.imu.topic = "/imu";
  recording.turn_rates = walk().imu;
  const auto found = estimated_with(recording, std::nullopt);
  expect_found(found, 0.3 * kMs, 4 * kMs);
  EXPECT_EQ(found->motion->kind, UsedMotion::Kind::kImu);
  EXPECT_EQ(found->motion->name, "/imu");
}

TEST(GivenPoses, OfTheRigsOdometryAreAPrior) {
  Recording recording = walk().recording;
  recording.rig.odometry.topic = "/odom";
  recording.odometry = true_poses(kShift_s);
  const auto found = estimated_with(recording, std::nullopt);
  expect_found(found, 0.1 * kMs, 2 * kMs);
  EXPECT_EQ(found->motion->kind, UsedMotion::Kind::kOdometry);
}

TEST(GivenPoses, OfAnotherTimeThatFitNoTurnsAreRefusedByName) {
  auto poses = true_poses(0);
  for (StampedPose& pose : poses) {
    pose.time_s += 500;
    pose.orientation = Eigen::Quaterniond::Identity();
  }
  const auto found = estimated_with(walk().recording, GivenPoses{"other.tum", std::move(poses), false});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ExitCode::kUnreadableInput);
  EXPECT_EQ(found.error().message.rfind("other.tum: the poses do not overlap the recording", 0), 0U)
      << found.error().message;
}

TEST(GivenPoses, OfARigThatStoodStillAreRefused) {
  const auto found = estimated_with(test::room(0.024), GivenPoses{"T.tum", true_poses(0), false});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(found.error().message.find("poses are not used for a stationary rig"), std::string::npos);
}

TEST(GivenPoses, AreForTheDirectMethodAlone) {
  EstimateOptions options;
  options.method = Method::kMoving;
  options.poses = GivenPoses{"T.tum", true_poses(0), false};
  const auto found = estimate(walk().recording, options, Job());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ExitCode::kWrongUsage);
}

}  // namespace
}  // namespace sweepscope
