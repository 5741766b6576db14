#include "core/offset/estimator.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/results/estimate_json.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::estimated;
using test::expect_refused;
using test::kMs;

EstimateOptions by(Method method) {
  EstimateOptions options;
  options.method = method;
  return options;
}

EstimateOptions over(double from_ms, double to_ms, double step_ms) {
  EstimateOptions options;
  options.ranges = {{from_ms * kMs, to_ms * kMs, step_ms * kMs}};
  return options;
}

double optimum_s(const Estimate& estimate, const std::string& criterion) {
  for (const CriterionOptimum& optimum : estimate.criteria)
    if (optimum.name == criterion) return optimum.offset_s;
  ADD_FAILURE() << "no criterion " << criterion;
  return 0;
}

class StandingInARoom : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(StandingInARoom, TheDefaultSearchFindsTheOffset) {
  const auto [truth_s, sweep_s] = GetParam();
  const Estimate found = estimated(test::room(truth_s, sweep_s), by(Method::kStationary));
  EXPECT_EQ(found.method, Method::kStationary);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, truth_s, 0.5 * kMs);
  EXPECT_EQ(*found.offset_s, optimum_s(found, "d"));
}

INSTANTIATE_TEST_SUITE_P(TruthsAndSweeps, StandingInARoom,
                         testing::Combine(testing::Values(-8 * kMs, 3.7 * kMs, 24 * kMs, 41 * kMs),
                                          testing::Values(0.5, 0.513)));

class WalkingThroughAStation : public testing::TestWithParam<double> {};

TEST_P(WalkingThroughAStation, EAndNAreExtremeAtTheOffset) {
  const double truth_ms = GetParam();
  const Recording& recording = test::simulated("metro-station", truth_ms * kMs, 30).recording;
  const Estimate found = estimated(recording, over(truth_ms - 5, truth_ms + 5, 1));
  EXPECT_EQ(found.method, Method::kMoving);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(optimum_s(found, "e"), truth_ms * kMs, 0.3 * kMs);
  EXPECT_NEAR(optimum_s(found, "n"), truth_ms * kMs, 1.0 * kMs);
  EXPECT_EQ(*found.offset_s, optimum_s(found, "e"));
}

INSTANTIATE_TEST_SUITE_P(Truths, WalkingThroughAStation, testing::Values(-8.0, 24.0));

TEST(Estimate, TheDefaultSearchOfAWalkComesNearItsOffset) {
  const Estimate found =
      estimated(test::simulated("metro-station", 0.024, 12).recording, by(Method::kMoving));
  EXPECT_EQ(found.method, Method::kMoving);
  ASSERT_TRUE(found.offset_s) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, 0.024, 1.0 * kMs);
}

// Rigs that tilt and yaw, with the laser off the axis, recorded by hand.
class OtherRigs : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(OtherRigs, AreEstimatedToo) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.noise_m = 0.01;
  bench.offset_s = 0.017;
  bench.mount.axis = GetParam();
  bench.mount.laser_in_motor_xyz_m = {0.06, 0.02, 0.05};
  // A yawing motor needs a scanner that stands upright.
  if (GetParam().z() == 1) bench.mount.laser_in_motor_rpy_deg = {90, 0, 0};
  const Estimate found = estimated(bench.record(), over(12, 22, 0.5));
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, 0.017, 0.6 * kMs);
}

INSTANTIATE_TEST_SUITE_P(RollTiltYaw, OtherRigs,
                         testing::Values(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                         Eigen::Vector3d::UnitZ()));

TEST(Estimate, WithoutOptionsIsTheDirectMethods) {
  const Estimate found = estimated(test::room(0.024)),
                 direct = estimated(test::room(0.024), by(Method::kDirect));
  EXPECT_EQ(found.method, Method::kDirect);
  EXPECT_EQ(estimate_to_json(found, Timing::kNull), estimate_to_json(direct, Timing::kNull));
  ASSERT_TRUE(found.fit);
  EXPECT_TRUE(found.fit->converged);
  EXPECT_GT(found.fit->iterations, 0);
  EXPECT_GT(found.fit->matches, found.fit->features / 10);
}

TEST(Estimate, WhatWasPreparedOnceGivesTheSameBytes) {
  const Recording& recording = test::room(0.024);
  const PreparedRecording prepared = prepare(recording, FeatureOptions(), Job()).value();
  for (const Method method : {Method::kDirect, Method::kStationary})
    EXPECT_EQ(estimate_to_json(*estimate(prepared, by(method), {}, Job()), Timing::kNull),
              estimate_to_json(estimated(recording, by(method)), Timing::kNull));
}

TEST(Estimate, AWindowOfARecordingIsEnough) {
  const Recording part = window(test::simulated("room-2", 0.024, 9).recording, 2.0, 6.5);
  const Estimate found = estimated(part, over(20, 28, 0.5));
  ASSERT_TRUE(found.identifiable);
  EXPECT_NEAR(*found.offset_s, 0.024, 0.6 * kMs);
  EXPECT_LT(found.scans, 190u);
}

TEST(Estimate, TheCurveHoldsTheCandidatesAskedForAndTheirEvidence) {
  EstimateOptions options;
  options.around = OffsetsAround{24 * kMs, 1 * kMs, 6};
  const Estimate found = estimated(test::room(0.024), options);
  ASSERT_EQ(found.curve.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(found.curve[i].offset_s, (21 + double(i)) * kMs, 1e-12);
    EXPECT_TRUE(found.curve[i].d && found.curve[i].signed_rotation_rad);
    EXPECT_FALSE(found.curve[i].n);
  }
  EXPECT_GE(found.sweeps, 8u);
  EXPECT_GT(found.scans, 140u);
  EXPECT_GT(found.sigma_s.value_or(0), 0);
  EXPECT_LT(found.sigma_s.value_or(1), 0.3 * kMs);
}

TEST(Estimate, SigmaKnowsOfWhatPullsAllPairsOfSweepsAlike) {
  // Every sweep takes 20 scans: lines of both directions see the same angles. With this seed d is 1 ms off.
  SimulationOptions options;
  options.scene = "room-3";
  options.seed = 16;
  options.motor = simulation::MotorKind::kSine;
  options.noise_m = 0.03;
  options.encoder_hz = 200;
  options.encoder_step_deg = 0.01;
  options.encoder_jitter_s = 0.001;
  options.offset_s = -43.34 * kMs;
  const Recording recording = simulate(options, Job()).value().recording;
  const Estimate found = estimated(recording, over(-47, -39, 0.1));
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  const double error_s = std::abs(*found.offset_s - options.offset_s);
  EXPECT_GT(error_s, 0.3 * kMs) << "d is off here";
  EXPECT_LT(error_s, 2 * found.sigma_s.value_or(0));
}

TEST(Estimate, ClocksThatDriftApartAreRefusedByThePapersMethodToo) {
  SimulationOptions options;
  options.duration_s = 10;
  options.clock_drift_ppm = 500;
  const Estimate found = estimated(simulate(options, Job()).value().recording, over(20, 32, 1));
  EXPECT_FALSE(found.identifiable);
  EXPECT_NE(testing::PrintToString(found.reasons()).find("drift apart"), std::string::npos)
      << testing::PrintToString(found.reasons());
  EXPECT_NEAR(found.drift_ppm.value_or(0), 500, 50);
}

TEST(Estimate, TheJsonIsTheSameForOneAndTwoThreadsAndRunAfterRun) {
  const auto json = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return estimate_to_json(estimated(test::room(0.0037), over(0, 8, 1)), Timing::kNull);
  };
  const std::string first = json(1);
  EXPECT_EQ(first, json(2));
  EXPECT_EQ(first, json(2));
}

TEST(Estimate, TheJsonOfAWalkIsTheSameForOneAndTwoThreads) {
  const auto json = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Recording& recording = test::simulated("metro-station", 0.024, 12).recording;
    return estimate_to_json(estimated(recording, over(22, 26, 1)), Timing::kNull);
  };
  EXPECT_EQ(json(1), json(2));
}

TEST(Refused, AStationaryMethodForAWalk) {
  EstimateOptions options = over(20, 28, 1);
  options.method = Method::kStationary;
  expect_refused(estimated(test::simulated("metro-station", 0.024, 12).recording, options), "The rig moved");
}

// Four and a half scans a sweep: errors of up to 34 ms that no scatter shows.
TEST(Refused, SweepsThatSeeTheSameFewLines) {
  for (const Method method : {Method::kDirect, Method::kStationary}) {
    EstimateOptions options;
    options.method = method;
    expect_refused(estimated(test::simulated("room-4", 0.012, 5, 0.1125).recording, options),
                   "scan lines, too few");
  }
}

TEST(Refused, AWalkThatIsTooShort) {
  expect_refused(estimated(test::simulated("metro-station", 0.024, 8).recording, over(20, 28, 1)),
                 "too short");
}

class BadMotor : public testing::TestWithParam<std::tuple<simulation::MotorKind, const char*>> {};

TEST_P(BadMotor, IsRefused) {
  SimulationOptions options;
  options.motor = std::get<0>(GetParam());
  options.duration_s = 2;
  expect_refused(estimated(simulate(options, Job()).value().recording), std::get<1>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(StuckAndOneWay, BadMotor,
                         testing::Values(std::tuple(simulation::MotorKind::kStuck, "does not move"),
                                         std::tuple(simulation::MotorKind::kOneWay, "one way only")));

TEST(Refused, AnExtremumOnTheEdgeOfTheRange) {
  expect_refused(estimated(test::room(0.024), over(26, 34, 1)), "edge of the searched range");
  expect_refused(estimated(test::room(0.024), over(14, 22, 1)), "edge of the searched range");
}

// A tube about the motor's axis looks the same whatever the motor's angle.
TEST(Refused, ASceneWithoutALever) {
  test::Bench bench;
  bench.mesh = simulation::rod({-12, 0, 0}, {12, 0, 0}, 1.6, 0.5, 180);
  bench.noise_m = 0.01;
  const Recording recording = bench.record();
  EstimateOptions options = over(-5, 5, 1);
  EXPECT_FALSE(estimated(recording, options).identifiable);
  options.assume = RigKind::kStationary;
  expect_refused(estimated(recording, options), "does not constrain the offset");
}

TEST(Estimate, ARangeWiderThanTheMotorAllowsIsWrongUsage) {
  const auto result = estimate(test::room(0.024), over(-260, 260, 10), Job());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::kWrongUsage);
}

TEST(Estimate, AnInterruptedSearchSaysSo) {
  Job job;
  job.cancel();
  const Estimate found = estimate(test::room(0.024), {}, job).value();
  EXPECT_TRUE(found.interrupted);
  EXPECT_FALSE(found.identifiable);
}

}  // namespace
}  // namespace sweepscope
