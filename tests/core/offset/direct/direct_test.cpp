#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/offset/direct/direct.hpp"
#include "core/offset/estimator.hpp"
#include "core/results/estimate_json.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::expect_refused;
using test::kMs;

Estimate directly(const Recording& recording, EstimateOptions options = {}) {
  options.method = Method::kDirect;
  return estimate(recording, options, Job()).value();
}

Recording made(const SimulationOptions& options) {
  return simulate(options, Job()).value().recording;
}

TEST(Direct, AnswersWhereTheLastStepsGoToAndFroByLessThanTheUncertainty) {
  SimulationOptions options;
  options.scene = "room-5";
  options.offset_s = 17.3 * kMs;
  options.noise_m = 0.030;
  const Estimate found = directly(made(options));
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  EXPECT_LT(std::abs(*found.offset_s - options.offset_s), 3 * *found.sigma_s);
}

// Truth, sweep, noise and the most that the answer may be off.
struct Standing {
  double truth_s, sweep_s, noise_m, max_error_s;
};

class DirectInARoom : public testing::TestWithParam<Standing> {};

TEST_P(DirectInARoom, FindsTheOffsetAndKnowsHowWell) {
  const Standing& given = GetParam();
  SimulationOptions options;
  options.scene = "room-3";
  options.offset_s = given.truth_s;
  options.sweep_s = given.sweep_s;
  options.noise_m = given.noise_m;
  const Estimate found = directly(made(options));
  EXPECT_EQ(found.method, Method::kDirect);
  EXPECT_EQ(found.kind, RigKind::kStationary);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, given.truth_s, given.max_error_s);
  EXPECT_GT(*found.sigma_s, 0);
  EXPECT_LT(*found.sigma_s, given.max_error_s);
  ASSERT_EQ(found.criteria.size(), 1u);
  EXPECT_EQ(found.criteria[0].name, "direct");
  EXPECT_EQ(found.criteria[0].offset_s, *found.offset_s);
}

INSTANTIATE_TEST_SUITE_P(
    TruthsSweepsAndNoise, DirectInARoom,
    testing::Values(Standing{-53 * kMs, 0.5, 0.01, 0.05 * kMs}, Standing{24 * kMs, 0.5, 0.01, 0.05 * kMs},
                    Standing{3.7 * kMs, 0.513, 0.01, 0.05 * kMs}, Standing{57 * kMs, 0.513, 0.01, 0.05 * kMs},
                    Standing{24 * kMs, 0.3, 0.01, 0.05 * kMs}, Standing{24 * kMs, 0.8, 0.03, 0.15 * kMs},
                    Standing{-8 * kMs, 0.5, 0.03, 0.15 * kMs}));

TEST(Direct, FindsTheOffsetWhereManyBeamsReturnNothing) {
  for (const double dropout : {0.1, 0.3, 0.5}) {
    SimulationOptions options;
    options.scene = "room-2";
    options.offset_s = 17.3 * kMs;
    options.dropout = dropout;
    const Estimate found = directly(made(options));
    ASSERT_TRUE(found.identifiable) << dropout << testing::PrintToString(found.reasons());
    EXPECT_NEAR(*found.offset_s, options.offset_s, 0.06 * kMs) << dropout;
    EXPECT_LT(*found.sigma_s, 0.03 * kMs) << dropout;
  }
}

// Of the first of these all sweeps and scans agree by chance, 0.35 ms off: only the stamps tell.
TEST(Direct, KnowsThatScatteredStampsTellLess) {
  for (const std::uint64_t seed : {700, 701, 702}) {
    SimulationOptions options{.scene = "room-5", .offset_s = -0.03273, .seed = seed, .duration_s = 4.4};
    options.sweep_s = 0.413;
    options.encoder_step_deg = 0.01;
    options.stamp_jitter_s = 1.1 * kMs;
    const Estimate found = directly(made(options));
    ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
    EXPECT_NEAR(*found.offset_s, -0.03273, 3 * *found.sigma_s);
    EXPECT_LT(*found.sigma_s, 0.25 * kMs);
  }
}

TEST(Direct, KnowsThatAMotorSampledSparselyTellsLess) {
  SimulationOptions options;
  options.scene = "room-4";
  options.motor = simulation::MotorKind::kTriangle;
  options.duration_s = 6;
  options.offset_s = 17.3 * kMs;
  for (const auto& [sweep_s, encoder_hz] : {std::pair{0.5, 10.0}, std::pair{0.2, 20.0}}) {
    options.sweep_s = sweep_s;
    options.encoder_hz = encoder_hz;
    const Estimate found = directly(made(options));
    ASSERT_TRUE(found.identifiable) << sweep_s << testing::PrintToString(found.reasons());
    EXPECT_LT(std::abs(*found.offset_s - options.offset_s), 3 * *found.sigma_s) << sweep_s;
    EXPECT_GT(*found.sigma_s, 0.1 * kMs) << sweep_s;
  }
  options.sweep_s = 0.2;
  options.encoder_hz = 10;
  expect_refused(directly(made(options)), "sampled only 2.0 times per sweep");
}

// The encoder runs ahead of the laser by 0.6 deg in either direction, above 20 deg only: 1.7 ms at 360 deg/s.
TEST(Direct, KnowsThatPlayWhichDependsOnTheAngleLeavesTheOffsetUncertain) {
  SimulationOptions options{.scene = "room-2", .offset_s = 0.024, .duration_s = 6};
  options.motor = simulation::MotorKind::kTriangle;
  Recording recording = made(options);
  const std::vector<double> angles_rad = recording.motor.angle_rad;
  for (std::size_t i = 1; i < angles_rad.size(); ++i)
    if (angles_rad[i] > 20 * kRadPerDeg)
      recording.motor.angle_rad[i] += (angles_rad[i] > angles_rad[i - 1] ? 1 : -1) * 0.6 * kRadPerDeg;
  const Estimate found = directly(recording);
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  EXPECT_GT(std::abs(*found.offset_s - 0.024), 0.3 * kMs);
  EXPECT_LT(std::abs(*found.offset_s - 0.024), 3 * *found.sigma_s);
  EXPECT_TRUE(std::ranges::any_of(found.warnings, [](const std::string& warning) {
    return warning.find("depends on the motor's angle") != std::string::npos;
  })) << testing::PrintToString(found.warnings);
}

// No sweep of one direction is followed by another: neighbours tell.
TEST(Direct, AWalkOfThreeSweepsIsNotTakenForAStationaryRig) {
  for (const char* walk : {"metro-station", "cemetery"})
    expect_refused(directly(test::simulated(walk, 0.024, 1.1).recording),
                   "neighbouring sweeps do not match at any offset");
  const Estimate standing = directly(test::simulated("room-1", 0.024, 1.1).recording);
  ASSERT_TRUE(standing.offset_s) << testing::PrintToString(standing.reasons());
  EXPECT_EQ(standing.kind_reason, "0 of 2 pairs of neighbouring sweeps differ at every offset.");
  EXPECT_NEAR(*standing.offset_s, 0.024, 0.1 * kMs);
}

TEST(Direct, AWalkWhoseSweepsTakeSecondsIsRefusedBeforeItIsSolved) {
  SimulationOptions options{.scene = "lecture-room", .offset_s = 0.024, .duration_s = 120};
  options.sweep_s = 5;
  const Estimate found = directly(made(options));
  expect_refused(found, "long enough for the rig to sway within it");
  EXPECT_FALSE(found.walk);
}

TEST(Direct, FindsTheOffsetOfAWalkAndKnowsHowWell) {
  const Estimate found = directly(test::simulated("metro-station", 0.024, 30).recording);
  EXPECT_EQ(found.method, Method::kDirect);
  EXPECT_EQ(found.kind, RigKind::kMoving);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, 0.024, 0.3 * kMs);
  EXPECT_NEAR(*found.offset_s, 0.024, 3 * *found.sigma_s);
  EXPECT_LT(*found.sigma_s, 0.6 * kMs);
}

TEST(Direct, AWalkFarFromZeroIsFoundToo) {
  const Estimate found = directly(test::simulated("metro-station", -0.047, 20).recording);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, -0.047, 1 * kMs);
}

TEST(Direct, TheJsonIsTheSameForOneAndTwoThreads) {
  const auto json = [](const Recording& recording, std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return estimate_to_json(directly(recording), Timing::kNull);
  };
  EXPECT_EQ(json(test::room(0.0037), 1), json(test::room(0.0037), 2));
  const Recording& walk = test::simulated("metro-station", 0.024, 12).recording;
  EXPECT_EQ(json(walk, 1), json(walk, 2));
}

// Rigs that tilt and yaw, with the laser off the axis, recorded by hand.
class DirectOnOtherRigs : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(DirectOnOtherRigs, FindsTheOffset) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.noise_m = 0.01;
  bench.offset_s = 0.017;
  bench.mount.axis = GetParam();
  bench.mount.laser_in_motor_xyz_m = {0.06, 0.02, 0.05};
  if (GetParam().z() == 1) bench.mount.laser_in_motor_rpy_deg = {90, 0, 0};
  const Estimate found = directly(bench.record());
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, 0.017, 0.06 * kMs);
}

INSTANTIATE_TEST_SUITE_P(RollTiltYaw, DirectOnOtherRigs,
                         testing::Values(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                         Eigen::Vector3d::UnitZ()));

TEST(DirectRefuses, ARigThatWasNudged) {
  SimulationOptions options;
  options.nudge_m = 0.05;
  expect_refused(directly(made(options)), "The rig moved");
}

TEST(Direct, AnswersForARigThatWasNudgedAndIsTreatedAsStationary) {
  SimulationOptions options;
  options.duration_s = 9;
  options.nudge_m = 0.03;
  EstimateOptions assumed;
  assumed.assume = RigKind::kStationary;
  const Estimate found = directly(made(options), assumed);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, options.offset_s, 3 * *found.sigma_s);
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_NE(found.warnings.front().find("The rig moved"), std::string::npos);
}

TEST(DirectRefuses, AWalkThatIsTreatedAsStationary) {
  EstimateOptions assumed;
  assumed.assume = RigKind::kStationary;
  expect_refused(directly(test::simulated("lecture-room", 0.024, 6).recording, assumed),
                 "too far from sweep to sweep");
}

TEST(DirectRefuses, AWalkWithASlowMotorThatSlowsDownAndSaysWhatWouldHelp) {
  SimulationOptions options{.scene = "metro-station", .offset_s = 0.012, .duration_s = 26};
  options.motor = simulation::MotorKind::kSine;
  options.sweep_s = 1.1;
  const Estimate found = directly(made(options));
  expect_refused(found, "With sweeps of 0.5 s it would be");
  expect_refused(found, "reverses at once does not have this limit");
  expect_refused(found, "There is too little information");
  EXPECT_EQ(found.reasons().size(), 3U) << testing::PrintToString(found.reasons());
}

TEST(DirectRefuses, ClocksThatDriftApartAndSaysByHowMuch) {
  SimulationOptions options;
  options.duration_s = 10;
  options.clock_drift_ppm = 500;
  const Estimate found = directly(made(options));
  expect_refused(found, "drift apart");
  EXPECT_NEAR(found.drift_ppm.value_or(0), 500, 30);
}

TEST(DirectRefuses, AnOffsetBeyondTheRange) {
  EstimateOptions options;
  options.ranges = {{26 * kMs, 40 * kMs, 1 * kMs}};
  expect_refused(directly(test::room(0.024), options), "edge of the searched range");
}

// A tube about the motor's axis looks the same whatever the motor's angle.
TEST(DirectRefuses, ASceneWithoutALever) {
  test::Bench bench;
  bench.mesh = simulation::rod({-12, 0, 0}, {12, 0, 0}, 1.6, 0.5, 180);
  bench.noise_m = 0.01;
  EstimateOptions options;
  options.assume = RigKind::kStationary;
  expect_refused(directly(bench.record(), options), "does not constrain the offset");
}

TEST(DirectRefuses, NothingOnGoodRecordings) {
  for (const char* scene : {"room-1", "room-2", "room-4", "room-5", "room-6"})
    for (const double sweep_s : {0.3, 0.8}) {
      SimulationOptions options;
      options.scene = scene;
      options.sweep_s = sweep_s;
      const Estimate found = directly(made(options));
      EXPECT_TRUE(found.identifiable) << scene << testing::PrintToString(found.reasons());
    }
}

}  // namespace
}  // namespace sweepscope
