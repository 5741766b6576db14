// Offsets of motors that turn one way, against the truth of simulated recordings.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/map/offset_map.hpp"
#include "core/offset/estimator.hpp"
#include "core/offset/rig_estimate.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

SimulationOptions one_way(const char* scene, std::uint64_t seed, std::vector<double> speeds_dps) {
  SimulationOptions options;
  options.scene = scene;
  options.seed = seed;
  options.motor = simulation::MotorKind::kOneWay;
  options.speeds_dps = std::move(speeds_dps);
  options.duration_s = 10;
  options.offset_s = (24.3 - double(seed) * 7.1) * kMs;
  return options;
}

Estimate found_in(const SimulationOptions& made, const EstimateOptions& options = {}) {
  return estimate(simulate(made, Job()).value().recording, options, Job()).value();
}

void expect_truth(const SimulationOptions& made, double max_error_s) {
  const Estimate found = found_in(made);
  EXPECT_EQ(found.kind, RigKind::kStationary);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, made.offset_s, max_error_s);
  EXPECT_NEAR(*found.offset_s, made.offset_s, 3 * *found.sigma_s);
}

bool says(const Estimate& estimate, const char* words) {
  return std::ranges::any_of(
      estimate.reasons(), [&](const std::string& reason) { return reason.find(words) != std::string::npos; });
}

TEST(OneWay, TwoSpeedsTellTheOffset) {
  expect_truth(one_way("room-1", 1, {360, 180}), 0.1 * kMs);
  expect_truth(one_way("room-4", 2, {170, 350}), 0.1 * kMs);
}

TEST(OneWay, ARampTellsTheOffset) {
  SimulationOptions made = one_way("room-3", 3, {360, 150});
  made.speed_ramp = true;
  expect_truth(made, 0.15 * kMs);
}

TEST(OneWay, TheEncodersZeroDoesNotMatter) {
  const SimulationOptions made = one_way("room-1", 1, {360, 180});
  Recording recording = simulate(made, Job()).value().recording;
  for (double& angle_rad : recording.motor.angle_rad) angle_rad += 1;
  const Estimate found = estimate(recording, {}, Job()).value();
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, made.offset_s, 0.1 * kMs);
}

TEST(OneWay, OneSpeedIsRefusedWithTheWayToRecordIt) {
  for (const double speed_dps : {360.0, 210.0}) {
    const Estimate refused = found_in(one_way("room-2", 5, {speed_dps}));
    EXPECT_FALSE(refused.identifiable);
    EXPECT_TRUE(says(refused, "record 5 s at one speed and 5 s at half of it."));
  }
}

TEST(OneWay, TheMotorsOwnUnevennessIsNoSecondSpeed) {
  SimulationOptions made = one_way("room-2", 6, {360});
  made.uneven_motor = 0.05;
  made.eccentricity_deg = 1;
  EXPECT_TRUE(says(found_in(made), "at one speed"));
}

TEST(OneWay, AMovingRigIsRefused) {
  SimulationOptions made = one_way("metro-station", 1, {360, 180});
  const Estimate refused = found_in(made);
  EXPECT_EQ(refused.kind, RigKind::kMoving);
  EXPECT_TRUE(says(refused, "its motor turns one way"));
}

TEST(OneWay, ThePapersCriteriaAreRefused) {
  EstimateOptions options;
  options.method = Method::kStationary;
  EXPECT_TRUE(
      says(found_in(one_way("room-1", 1, {360, 180}), options), "Use the direct method (--method direct)."));
}

TEST(OneWay, ARigThatIsPushedAsideIsRefusedOrTakenToMove) {
  SimulationOptions made = one_way("room-1", 4, {360, 180});
  made.nudge_m = 0.2;
  EXPECT_FALSE(found_in(made).identifiable);
}

// The mount but for its gauges, a turn about the motor's axis and a shift along it.
struct MountError {
  double axis_deg = 0, shift_m = 0;
};
MountError error_of(const Mount& found, const SimulationOptions& made) {
  const auto in_laser = [](const Eigen::Vector3d& rpy_deg, const Eigen::Vector3d& shift_m) {
    const Eigen::Quaterniond laser_from_motor = rotation_from_rpy(rpy_deg).conjugate();
    const Eigen::Vector3d axis = laser_from_motor * Eigen::Vector3d::UnitX(),
                          origin_m = laser_from_motor * -shift_m;
    return std::pair(axis, Eigen::Vector3d(origin_m - axis * axis.dot(origin_m)));
  };
  const auto [axis, origin_m] = in_laser(found.laser_in_motor_rpy_deg, found.laser_in_motor_xyz_m);
  const auto [true_axis, true_origin_m] = in_laser(made.mount_error_deg, made.mount_error_m);
  return {std::asin(axis.cross(true_axis).norm()) * kDegPerRad, (origin_m - true_origin_m).norm()};
}

TEST(OneWay, AtOneSpeedTheMountIsFoundWithoutAnOffset) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SimulationOptions made = one_way(seed == 2 ? "room-4" : "room-2", seed, {350});
    made.duration_s = 8;
    made.mount_error_deg = {0, 3 - double(seed), 2.5};
    made.mount_error_m = {0, 0.04, -0.02 * double(seed)};
    EstimateOptions options;
    options.solve.mount = true;
    const Estimate found = found_in(made, options);
    EXPECT_TRUE(found.offset_is_gauge());
    EXPECT_FALSE(found.offset_s || found.sigma_s);
    EXPECT_EQ(found.kind, RigKind::kStationary);
    ASSERT_TRUE(found.rig && found.rig->mount.identifiable) << seed;
    EXPECT_TRUE(has_answer(found));
    const MountError error = error_of(found.rig->rig.mount, made);
    EXPECT_LT(error.axis_deg, 0.02) << seed;
    EXPECT_LT(error.shift_m, 0.001) << seed;
    EXPECT_LT(found.rig->residual_after_m, 0.7 * found.rig->residual_before_m);
  }
}

TEST(OneWay, AtOneSpeedTheMountOfA3dScannerIsFound) {
  SimulationOptions made = one_way("room-3", 4, {350});
  made.scanner = *simulation::scanner("vlp16");
  made.duration_s = 4;
  made.mount_error_deg = {0, -4, 3};
  made.mount_error_m = {0, 0.05, -0.03};
  EstimateOptions options;
  options.solve.mount = true;
  const Estimate found = found_in(made, options);
  ASSERT_TRUE(found.rig && found.rig->mount.identifiable);
  const MountError error = error_of(found.rig->rig.mount, made);
  EXPECT_LT(error.axis_deg, 0.01);
  EXPECT_LT(error.shift_m, 0.0005);
}

// 10 scans a second, 35 deg apart: whether the rig moved cannot be seen.
TEST(OneWay, AtOneSpeedSparseLinesAreTheReasonAndNotAMotion) {
  SimulationOptions made = one_way("room-1", 1, {350});
  made.scanner = *simulation::scanner("rplidar-s2");
  made.beam_times = simulation::BeamTimes::kSpread;
  made.duration_s = 8;
  made.mount_error_deg = {0, -2, 0.7};
  made.mount_error_m = {0, -0.03, 0.015};
  EstimateOptions options;
  options.solve.mount = true;
  const Estimate refused = found_in(made, options);
  ASSERT_FALSE(has_answer(refused));
  const std::string warnings = testing::PrintToString(refused.warnings);
  EXPECT_NE(warnings.find("Turn the motor more slowly."), std::string::npos) << warnings;
  EXPECT_EQ(warnings.find("it moved"), std::string::npos) << warnings;
}

TEST(OneWay, AtOneSpeedAMountThatIsNotAskedForIsNoAnswer) {
  const Estimate refused = found_in(one_way("room-2", 5, {360}));
  EXPECT_TRUE(refused.offset_is_gauge());
  EXPECT_FALSE(has_answer(refused));
}

// Any two are the same but for a turn about the motor's axis, x.
TEST(OneWay, AtOneSpeedMapsAreDrawnAtAnyOffset) {
  const SimulationOptions made = one_way("room-2", 5, {360});
  const Recording recording = simulate(made, Job()).value().recording;
  const double offsets_s[] = {0, 0.02};
  const auto maps = build_maps(recording, offsets_s, {}, Job());
  ASSERT_TRUE(maps) << maps.error().message;
  EXPECT_NE(maps->front().warning.find("any offset gives this map but for a turn"), std::string::npos);
  EXPECT_FALSE(maps->front().moving);
  const auto &first = *maps->at(0).cloud, &second = *maps->at(1).cloud;
  ASSERT_EQ(first.size(), second.size());
  const Eigen::AngleAxisd turn(360 * kRadPerDeg * 0.02, Eigen::Vector3d::UnitX());
  std::size_t apart = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Eigen::Vector3d p_m = first[i].getVector3fMap().cast<double>(),
                          q_m = second[i].getVector3fMap().cast<double>();
    if ((turn * p_m - q_m).norm() > 0.002 * (1 + p_m.norm())) ++apart;
  }
  EXPECT_LT(apart, first.size() / 100);
}

// Root of the mean square distance of the positions, after the best rigid motion.
double apart_m(const std::vector<StampedPose>& path, const std::vector<TruthPose>& truth) {
  Eigen::Matrix3Xd from(3, Eigen::Index(path.size())), to = from;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto at = std::ranges::lower_bound(truth, path[i].time_s, {}, &TruthPose::time_s);
    from.col(Eigen::Index(i)) = path[i].position_m;
    to.col(Eigen::Index(i)) = (at == truth.end() ? truth.back() : *at).position_m;
  }
  const Eigen::Matrix4d to_from = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd moved =
      (to_from.topLeftCorner<3, 3>() * from).colwise() + to_from.topRightCorner<3, 1>();
  return std::sqrt((moved - to).colwise().squaredNorm().mean());
}

// At an offset of 0 the base frame is turned by 8.5 deg about the motor's axis.
TEST(OneWay, AtOneSpeedAWalkIsFollowedAtAnyOffset) {
  SimulationOptions made = one_way("metro-station", 0, {350});
  made.duration_s = 20;
  const Simulation simulation = simulate(made, Job()).value();
  for (const double offset_s : {made.offset_s, 0.0}) {
    const auto maps = build_maps(simulation.recording, {&offset_s, 1}, {}, Job());
    ASSERT_TRUE(maps) << maps.error().message;
    EXPECT_TRUE(maps->front().moving);
    EXPECT_FALSE(maps->front().lost) << offset_s;
    EXPECT_LT(apart_m(maps->front().trajectory, simulation.truth), 0.05) << offset_s;
  }
}

}  // namespace
}  // namespace sweepscope
