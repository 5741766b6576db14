// Offsets from clouds of 3D scanners, against the truth that the rays were made with.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/simulation/scenes/scene.hpp"
#include "tests/core/cloud_bench.hpp"

namespace sweepscope {
namespace {

using test::CloudBench, test::kDegree;

std::string reasons(const Estimate& estimate) {
  std::string text;
  for (const std::string& reason : estimate.reasons()) text += reason + "\n";
  return text;
}

EstimateOptions direct() {
  EstimateOptions options;
  options.method = Method::kDirect;
  return options;
}

/// Within three of its own sigmas, and those worth having.
void expect_answer(const Estimate& found, RigKind kind, double truth_s, double max_sigma_ms) {
  ASSERT_TRUE(found.offset_s) << reasons(found);
  ASSERT_TRUE(found.sigma_s);
  testing::Test::RecordProperty("error_ms", fmt::format("{:.4f}", (*found.offset_s - truth_s) * 1e3));
  testing::Test::RecordProperty("sigma_ms", fmt::format("{:.4f}", *found.sigma_s * 1e3));
  EXPECT_EQ(found.kind, kind);
  EXPECT_LT(*found.sigma_s * 1e3, max_sigma_ms);
  EXPECT_NEAR(*found.offset_s * 1e3, truth_s * 1e3, 3 * *found.sigma_s * 1e3);
}

TEST(CloudOffset, StandingInAHall) {
  const CloudBench bench;
  const Recording recording = bench.record();
  EXPECT_EQ(recording.scans.size(), 185U * 16U);
  EXPECT_TRUE(recording.report.warnings.empty()) << recording.report.warnings.front();
  EXPECT_NEAR(recording.report.laser_stamps.median_period_s, 0.1, 1e-6);
  expect_answer(test::estimated(recording, direct()), RigKind::kStationary, bench.offset_s, 0.5);
}

TEST(CloudOffset, StandingRolledSpunTheOtherWayAndTwiceAsFast) {
  CloudBench bench;
  bench.offset_s = -0.0311;
  bench.clockwise = false;
  bench.axis = Eigen::Vector3d::UnitX();
  bench.turn_s = 0.05;
  bench.sweep_s = 1.33;
  bench.beams = 360;
  bench.duration_s = 11;
  expect_answer(test::estimated(bench.record(), direct()), RigKind::kStationary, bench.offset_s, 1.0);
}

TEST(CloudOffset, StandingInAFurnishedRoom) {
  const auto scene = simulation::make_scene("room-2");
  const auto stand = std::get<simulation::Stand>(scene->motion);
  CloudBench bench;
  bench.mesh = scene->mesh;
  bench.world_from_base = [&](double) {
    return Eigen::Isometry3d(Eigen::Translation3d(stand.position_m) *
                             Eigen::AngleAxisd(stand.yaw_deg * kDegree, Eigen::Vector3d::UnitZ()));
  };
  bench.offset_s = 0.0071;
  bench.swing_deg = 60;
  bench.sweep_s = 3.1;
  bench.duration_s = 20;
  bench.noise_m = 0.02;
  expect_answer(test::estimated(bench.record(), direct()), RigKind::kStationary, bench.offset_s, 1.0);
}

TEST(CloudOffset, APlaneScannerWhoseDriverSendsClouds) {
  CloudBench bench;
  bench.rings = 1;
  bench.ring_field = false;  // lines are slices of time
  bench.turn_s = 0.025;
  bench.beams = 720;
  bench.axis = Eigen::Vector3d::UnitX();
  bench.sweep_s = 0.513;
  bench.swing_deg = 90;
  bench.duration_s = 4.5;
  bench.offset_s = -0.0127;
  expect_answer(test::estimated(bench.record(), direct()), RigKind::kStationary, bench.offset_s, 0.2);
}

TEST(CloudOffset, ALivoxDriversMessageGivesTheEstimateOfThePointCloud) {
  CloudBench bench;
  bench.duration_s = 9;
  bench.driver = CloudBench::Driver::kNanoseconds;
  const Estimate of_cloud = test::estimated(bench.record(), direct());
  expect_answer(of_cloud, RigKind::kStationary, bench.offset_s, 1.0);
  for (const auto driver : {CloudBench::Driver::kLivox, CloudBench::Driver::kLivox2}) {
    bench.driver = driver;
    const Estimate of_livox = test::estimated(bench.record(), direct());
    EXPECT_EQ(of_livox.offset_s, of_cloud.offset_s);
    EXPECT_EQ(of_livox.sigma_s, of_cloud.sigma_s);
    EXPECT_EQ(of_livox.scans, of_cloud.scans);
  }
}

TEST(CloudOffset, APatternThatDoesNotRepeatItself) {
  CloudBench bench;
  bench.rosette = true;
  bench.rings = 2;
  bench.beams = 1000;
  bench.duration_s = 14;
  bench.driver = CloudBench::Driver::kLivox2;
  const Recording recording = bench.record();
  EXPECT_TRUE(recording.report.warnings.empty()) << recording.report.warnings.front();
  EXPECT_EQ(recording.scans.size(), 140U * 2U * 10U);  // slices of 10 ms of each line
  EstimateOptions stationary;
  stationary.method = Method::kStationary;
  stationary.ranges = {{bench.offset_s - 0.006, bench.offset_s + 0.0061, 0.002}};
  const Estimate found = test::estimated(recording, stationary);
  ASSERT_TRUE(found.offset_s) << reasons(found);
  EXPECT_NEAR(*found.offset_s * 1e3, bench.offset_s * 1e3, 1.0);
  const Estimate refused = test::estimated(recording, direct());
  ASSERT_FALSE(refused.offset_s);
  EXPECT_NE(reasons(refused).find("lines do not repeat"), std::string::npos) << reasons(refused);
}

TEST(CloudOffset, AWalkInAHall) {
  CloudBench bench;
  bench.world_from_base = test::walk_in_hall;
  bench.sweep_s = 1.57;
  bench.duration_s = 42;
  bench.beams = 300;
  bench.offset_s = -0.0186;
  const Recording recording = bench.record();
  expect_answer(test::estimated(recording, direct()), RigKind::kMoving, bench.offset_s, 2.0);
  EstimateOptions moving;
  moving.method = Method::kMoving;
  moving.ranges = {{bench.offset_s - 0.003, bench.offset_s + 0.0031, 0.001}};
  const Estimate found = test::estimated(recording, moving);
  ASSERT_TRUE(found.offset_s) << reasons(found) << *test::estimated(recording, direct()).offset_s << " "
                              << *test::estimated(recording, direct()).sigma_s;
  EXPECT_NEAR(*found.offset_s * 1e3, bench.offset_s * 1e3, 1.0);
}

TEST(CloudOffset, AWalkWithAPatternThatDoesNotRepeatItself) {
  CloudBench bench;
  bench.world_from_base = test::walk_in_hall;
  bench.sweep_s = 1.57;
  bench.duration_s = 42;
  bench.rosette = true;
  bench.rings = 2;
  bench.beams = 1000;
  bench.driver = CloudBench::Driver::kLivox2;
  expect_answer(test::estimated(bench.record(), direct()), RigKind::kMoving, bench.offset_s, 5.0);
}

TEST(CloudOffset, AWalkInAHallWithASlowerMotor) {
  CloudBench bench;
  bench.world_from_base = test::walk_in_hall;
  bench.duration_s = 50;
  bench.beams = 300;
  expect_answer(test::estimated(bench.record(), direct()), RigKind::kMoving, bench.offset_s, 2.0);
}

TEST(CloudOffset, NoLeverNoAnswer) {
  CloudBench bench;
  bench.axis = Eigen::Vector3d::UnitZ();  // turned about the scanner's own axis in an empty field
  bench.laser_in_motor_m = Eigen::Vector3d::Zero();
  bench.mesh = simulation::box({-40, -40, -1.6}, {40, 40, -1.5});
  bench.duration_s = 9;
  const Estimate found = test::estimated(bench.record(), direct());
  EXPECT_FALSE(found.offset_s);
  EXPECT_FALSE(found.reasons().empty());
}

}  // namespace
}  // namespace sweepscope
