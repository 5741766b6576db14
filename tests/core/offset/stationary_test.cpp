#include "core/offset/stationary.hpp"

#include <gtest/gtest.h>

#include "core/offset/rig_motion.hpp"
#include "core/offset/still_motion.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kTruth_s = 0.024;

// 9 s in a room.
class Room : public testing::Test {
 protected:
  std::vector<PairMotion> pairs(double off_s) const {
    return pair_motions(problem_, kTruth_s + off_s, OdometryOptions());
  }
  CurvePoint candidate(double off_s, const std::vector<std::size_t>& of_pairs, double weight_c = 1) const {
    return stationary_candidate(problem_, kTruth_s + off_s, of_pairs, weight_c, OdometryOptions());
  }
  const Recording& recording_ = test::simulated("room-1", kTruth_s, 9, 0.513).recording;
  const OffsetProblem problem_ = test::problem_of(recording_);
};

TEST_F(Room, DDoesNotGrowWithTheNumberOfSweeps) {
  std::vector<std::size_t> first, last;
  for (std::size_t sweep = 1; sweep <= 5; ++sweep) first.push_back(sweep), last.push_back(sweep + 9);
  const CurvePoint early = candidate(0, first), late = candidate(0, last);
  EXPECT_LT(*late.d, 1.5 * *early.d);
  EXPECT_LT(*late.d, 0.02);
}

TEST_F(Room, DCombinesTranslationAndRotationByItsWeight) {
  const CurvePoint one = candidate(0, {3}), four = candidate(0, {3}, 4);
  EXPECT_NEAR(*one.d, std::hypot(*one.translation_m, *one.rotation_rad), 1e-15);
  EXPECT_NEAR(*four.d, std::hypot(*four.translation_m, 2 * *four.rotation_rad), 1e-15);
}

TEST_F(Room, TheSignedRotationIsTwiceTheMotorsSpeedTimesTheError) {
  const double speed_rad_s = problem_.motor.median_speed_rad_s;
  const CurvePoint below = candidate(-2 * kMs, {3, 4, 5, 6}), above = candidate(2 * kMs, {3, 4, 5, 6});
  EXPECT_NEAR(*above.signed_rotation_rad, 2 * speed_rad_s * 2 * kMs, 0.15 * 2 * speed_rad_s * 2 * kMs);
  EXPECT_NEAR(*below.signed_rotation_rad, -*above.signed_rotation_rad, 0.1 * *above.signed_rotation_rad);
}

TEST_F(Room, APairThatIsMissingMakesTheCandidateFail) {
  const CurvePoint point = candidate(0, {3, 4, 999});
  EXPECT_FALSE(point.d);
  EXPECT_FALSE(point.signed_rotation_rad);
  EXPECT_FALSE(candidate(0, {}).d);
}

MotionTest tested(const Recording& recording, double offset_s) {
  const OffsetProblem problem = test::problem_of(recording);
  return test_motion(still_grid(problem), offset_s);
}

TEST(MotionOfTheRig, ARoomStandsAlsoAtAWrongOffset) {
  for (const double offset_s : {kTruth_s, -0.04}) {
    const MotionTest test = tested(test::room(kTruth_s), offset_s);
    EXPECT_GE(test.pairs, 4u);
    EXPECT_FALSE(test.moving()) << test.moved << " of " << test.pairs;
    EXPECT_LT(test.median_translation_m, 0.01);
  }
}

TEST(MotionOfTheRig, AWalkMovesAlsoAtAWrongOffset) {
  for (const double offset_s : {kTruth_s, -0.04}) {
    const MotionTest test = tested(test::simulated("metro-station", kTruth_s, 8).recording, offset_s);
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
      bench.offset_s = kTruth_s;
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
      const MotionTest test = tested(test::simulated(scene, kTruth_s, 6, sweep_s).recording, kTruth_s);
      EXPECT_TRUE(test.moving()) << scene << " " << sweep_s << ": " << test.moved << " of " << test.pairs;
    }
}

// 1.5 cm from one sweep to the next but one, in a hall.
TEST(MotionOfTheRig, IsSeenWhereItIsSlow) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.noise_m = 0.01;
  bench.duration_s = 7;
  bench.offset_s = kTruth_s;
  bench.world_from_base = [](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.015 * t_s, 0.005 * t_s, 0));
  };
  const MotionTest test = tested(bench.record(), kTruth_s);
  EXPECT_TRUE(test.moving()) << test.moved << " of " << test.pairs << ", " << test.far_moved << " of "
                             << test.far_pairs;
}

TEST(MotionOfTheRig, IsNoneWhereTheClocksDriftApart) {
  SimulationOptions options;
  options.duration_s = 10;
  options.clock_drift_ppm = 500;
  EXPECT_FALSE(tested(simulate(options, Job()).value().recording, options.offset_s).moving());
}

TEST(MotionOfTheRig, TooFewSweepsAreNoAnswer) {
  const Recording part = window(test::room(kTruth_s), 0, 0.9);
  EXPECT_FALSE(test_motion(still_grid(test::problem_of(part)), kTruth_s).answered());
}

}  // namespace
}  // namespace sweepscope
