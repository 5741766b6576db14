#include "core/offset/kind/stationary_motion.hpp"

#include <gtest/gtest.h>

#include "core/offset/kind/sweep_shift.hpp"
#include "core/simulation/typed_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

constexpr double kStoodTruth_s = 0.024;

MotionTest tested(const Recording& recording, double offset_s) {
  const OffsetProblem problem = test::problem_of(recording);
  return test_motion(stationary_grid(problem), offset_s);
}

TEST(MotionOfTheRig, ARoomStandsAlsoAtAWrongOffset) {
  for (const double offset_s : {kStoodTruth_s, -0.04}) {
    const MotionTest test = tested(test::room(kStoodTruth_s), offset_s);
    EXPECT_GE(test.pairs, 4u);
    EXPECT_FALSE(test.moving()) << test.moved << " of " << test.pairs;
    EXPECT_LT(test.median_translation_m, 0.01);
  }
}

TEST(MotionOfTheRig, AWalkMovesAlsoAtAWrongOffset) {
  for (const double offset_s : {kStoodTruth_s, -0.04}) {
    const MotionTest test = tested(test::simulated("metro-station", kStoodTruth_s, 8).recording, offset_s);
    EXPECT_TRUE(test.moving()) << test.moved << " of " << test.pairs;
  }
}

// Rough ground, trunks, twigs, and leaves from the ground up, which every sweep hits elsewhere.
simulation::Mesh forest(std::uint64_t seed) {
  simulation::Random random(seed, 1, 0);
  const auto about = [&](double middle, double reach) { return middle + reach * (2 * random.uniform() - 1); };
  simulation::Mesh mesh = simulation::box({-14, -14, -2.2}, {14, 14, -1.2});
  for (int tree = 0; tree < 24; ++tree) {
    const double away_m = 1.7 + 7 * random.uniform(), angle_rad = 2 * test::kPi * random.uniform();
    const Eigen::Vector3d foot_m(away_m * std::cos(angle_rad), away_m * std::sin(angle_rad), -1.4);
    mesh.add(simulation::rod(foot_m, foot_m + Eigen::Vector3d(about(0, 0.4), about(0, 0.4), 5), 0.1));
    for (int leaf = 0; leaf < 900; ++leaf) {
      const Eigen::Vector3d a = foot_m + Eigen::Vector3d(about(0, 0.9), about(0, 0.9), about(1.7, 1.6));
      const auto corner = [&] { return a + 0.1 * Eigen::Vector3d(about(0, 1), about(0, 1), about(0, 1)); };
      if (a.head<2>().norm() > 0.7) mesh.triangles.push_back({a, corner(), corner()});
    }
  }
  return mesh;
}

TEST(MotionOfTheRig, IsNoneAmongTrees) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    for (const double sweep_s : {0.3, 0.7}) {
      test::Bench bench;
      bench.mesh = forest(seed);
      bench.noise_m = 0.01;
      bench.duration_s = 7;
      bench.sweep_s = sweep_s;
      bench.offset_s = kStoodTruth_s;
      const MotionTest test = tested(bench.record(), 0);
      EXPECT_GE(test.pairs, 4u);
      EXPECT_FALSE(test.moving()) << seed << ": " << test.moved << " of " << test.pairs << ", "
                                  << test.far_moved << " of " << test.far_pairs;
    }
  }
}

TEST(MotionOfTheRig, IsNoneWherePeopleWalkBy) {
  SimulationOptions options;
  options.duration_s = 6;
  options.people = 6;
  options.sweep_s = 0.3;
  for (const std::uint64_t seed : {4, 5, 6}) {
    options.seed = seed;
    const MotionTest test = tested(simulate(options, Job()).value().recording, options.offset_s);
    EXPECT_FALSE(test.moving()) << seed << ": " << test.moved << " of " << test.pairs;
  }
}

TEST(MotionOfTheRig, IsSeenInTheFirstSecondsOfEveryWalk) {
  for (const char* scene : {"metro-station", "parking-area", "cemetery", "lecture-room"})
    for (const double sweep_s : {0.5, 0.556}) {
      const MotionTest test =
          tested(test::simulated(scene, kStoodTruth_s, 6, sweep_s).recording, kStoodTruth_s);
      EXPECT_TRUE(test.moving()) << scene << " " << sweep_s << ": " << test.moved << " of " << test.pairs;
    }
}

// A corridor looks alike along its length, and 10 lines a sweep see little of its doors: a shift of 12
// matches is found in few pairs, smaller ones in most.
TEST(MotionOfTheRig, IsSeenWhereManyPairsShowALittleOfIt) {
  TypedSimulation walk;
  walk.world = "corridor:40011";
  walk.walk = "brisk:40011";
  walk.scanner = "tim571";
  walk.motor = "sine";
  walk.offset_ms = 23.21;
  walk.options.seed = 40011;
  walk.options.sweep_s = 0.653;
  walk.options.duration_s = 67;
  const SimulationOptions options = simulation_of(walk).value();
  const MotionTest test = tested(simulate(options, Job()).value().recording, options.offset_s);
  EXPECT_LE(4 * test.moved, test.pairs);
  EXPECT_TRUE(test.moving()) << test.evidence << " of " << test.pairs;
}

// 1.5 cm from one sweep to the next but one, in a hall.
TEST(MotionOfTheRig, IsSeenWhereItIsSlow) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.noise_m = 0.01;
  bench.duration_s = 7;
  bench.offset_s = kStoodTruth_s;
  bench.world_from_base = [](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.015 * t_s, 0.005 * t_s, 0));
  };
  const MotionTest test = tested(bench.record(), kStoodTruth_s);
  EXPECT_TRUE(test.moving()) << test.moved << " of " << test.pairs << ", " << test.far_moved << " of "
                             << test.far_pairs;
}

TEST(MotionOfTheRig, IsNoneWhereTheClocksDriftApart) {
  SimulationOptions options;
  options.duration_s = 10;
  options.clock_drift_ppm = 500;
  EXPECT_FALSE(tested(simulate(options, Job()).value().recording, options.offset_s).moving());
}

TEST(MotionOverTime, ShowsWhenARigThatStoodBeganToMove) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.duration_s = 16;
  bench.offset_s = kStoodTruth_s;
  bench.world_from_base = [](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.4 * std::max(0.0, t_s - 8), 0, 0));
  };
  const Recording recording = bench.record();
  const OffsetProblem problem = test::problem_of(recording);
  const auto parts = motion_over_time(stationary_grid(problem), -0.04);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_FALSE(parts[0].moved);
  EXPECT_TRUE(parts[1].moved);
  EXPECT_EQ(parts[0].begin_s, 0);
  EXPECT_NEAR(parts[0].end_s, 8, 1.6) << "within a pair of sweeps";
  EXPECT_EQ(parts[1].begin_s, parts[0].end_s);
  EXPECT_NEAR(parts[1].end_s, 16, 0.3);
}

TEST(MotionOverTime, IsUnknownWithoutTwoSweepsOfOneDirection) {
  const Recording part = window(test::room(kStoodTruth_s), 0, 0.9);
  EXPECT_TRUE(motion_over_time(stationary_grid(test::problem_of(part)), kStoodTruth_s).empty());
}

TEST(MotionOfTheRig, TooFewSweepsAreNoAnswer) {
  const Recording part = window(test::room(kStoodTruth_s), 0, 0.9);
  EXPECT_FALSE(test_motion(stationary_grid(test::problem_of(part)), kStoodTruth_s).answered());
}

// How sweep 4 of a rig in a hall lies against sweep 2, which turned the same way 1.03 s before.
SweepShift shift_of(const Eigen::Vector3d& velocity_m_s) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.duration_s = 3.5;
  bench.offset_s = kStoodTruth_s;
  bench.world_from_base = [&](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(t_s * velocity_m_s));
  };
  const Recording recording = bench.record();
  const OffsetProblem problem = test::problem_of(recording);
  const StationaryGrid grid = stationary_grid(problem);
  const StationaryPoints points = place_stationary(grid, kStoodTruth_s, StationaryDetail::kPoints);
  const std::vector<LinePool> pools = pools_by_sweep(points);
  return shift_between(points, pools.at(2), pools.at(4), grid).value();
}

TEST(SweepShift, IsTheWayThatTheRigWentInTheMeantime) {
  const Eigen::Vector3d velocity_m_s(0.03, -0.02, 0.01);
  const SweepShift shift = shift_of(velocity_m_s);
  EXPECT_LT((shift.translation_m - 2 * test::Bench().sweep_s * velocity_m_s).norm(), 0.003)
      << shift.translation_m.transpose();
  EXPECT_LT(shift.rotation_rad, 0.002);
  EXPECT_GT(shift.gained_matches, 100);
}

TEST(SweepShift, OfAStationaryRigGainsNothing) {
  const SweepShift shift = shift_of(Eigen::Vector3d::Zero());
  EXPECT_GT(shift.matches, 1000U);
  EXPECT_LT(shift.translation_m.norm(), 0.001);
  EXPECT_LT(shift.gained_matches, 5);
}

}  // namespace
}  // namespace sweepscope
