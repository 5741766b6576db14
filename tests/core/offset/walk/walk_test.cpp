#include "core/offset/walk/walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/loam/path/given_motion.hpp"
#include "core/loam/path/straighten.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

const Simulation& short_walk() {
  return test::simulated("metro-station", 0.024, 20);
}

std::optional<SolvedWalk> solved_with(const MappingOptions& mapping) {
  const OffsetProblem problem = test::problem_of(short_walk().recording);
  return solve_walk(problem, 0.024, walk_options(mapping, search_scale(problem.motor)), Job());
}

double move_apart_m(const SweepPose& a, const SweepPose& b) {
  return (a.begin().inverse() * a.end() * (b.begin().inverse() * b.end()).inverse()).translation_m.norm();
}

// By how much the motion over so many sweeps differs from the true one, root of the mean square.
double motion_error_m(const Simulation& simulation, const std::vector<SweepPose>& sweeps,
                      std::size_t over = 1) {
  std::vector<StampedPose> poses;
  for (const TruthPose& pose : simulation.truth)
    poses.push_back({pose.time_s, pose.position_m, pose.orientation});
  const GivenMotion truth(poses, GivenMotion::Parts::kRotationAndTranslation, GivenMotion::Role::kTruth);
  double sum_m2 = 0;
  std::size_t count = 0;
  for (std::size_t k = 1; k + over < sweeps.size(); ++k, ++count) {
    SweepPose found = sweeps[k], given = found;
    found.knots = {sweeps[k].begin(), sweeps[k + over - 1].end()};
    given.knots = {truth.at(given.begin_s), truth.at(sweeps[k + over - 1].end_s)};
    sum_m2 += std::pow(move_apart_m(found, given), 2);
  }
  return std::sqrt(sum_m2 / double(count));
}

TEST(SolvedWalk, IsMoreAccurateThanTheTrackedOne) {
  const OffsetProblem problem = test::problem_of(short_walk().recording);
  const auto walk = solved_with({});
  ASSERT_TRUE(walk);
  const TrackedWalk tracked = track(problem, walk->tracked_at_s, MappingOptions(), Job()).value();
  const std::vector<SweepPose> straight = straightened(tracked.sweeps);
  ASSERT_EQ(walk->sweeps.size(), straight.size());
  EXPECT_LT(motion_error_m(short_walk(), straight), motion_error_m(short_walk(), tracked.sweeps));
  EXPECT_LT(motion_error_m(short_walk(), walk->sweeps), 0.4 * motion_error_m(short_walk(), straight));
  EXPECT_GT(walk->misfit_m, 0);
}

TEST(SolvedWalk, PiecesOfALongWalkBeginAndEndWhereTheyWereTracked) {
  const OffsetProblem problem = test::problem_of(short_walk().recording);
  const std::vector<SweepPose> tracked = track(problem, 0.024, MappingOptions(), Job()).value().sweeps;
  JointWalkOptions options;
  options.longest_s = 10;
  const std::vector<SweepPose> walk = adjusted(problem, tracked, 0.024, options, Job()).sweeps;
  const std::size_t middle = (tracked.size() + 1) / 2;  // where the second of two pieces begins
  const auto moved_m = [&](std::size_t k) {
    return (walk[k].begin().translation_m - tracked[k].begin().translation_m).norm();
  };
  EXPECT_LT(moved_m(middle), 0.01);
  EXPECT_GT(moved_m(middle / 2), 0.02);
  const auto gap_m = [&](const std::vector<SweepPose>& sweeps) {
    return (sweeps[middle - 1].end().translation_m - sweeps[middle].begin().translation_m).norm();
  };
  EXPECT_LT(gap_m(walk), gap_m(tracked) + 0.005);
}

// The two sides of a floor are two surfaces.
TEST(SolvedWalk, OnStairsIsMoreAccurateThanTheTrackedOne) {
  SimulationOptions options;
  options.random = {"stairs", "brisk", 300102, 300102};
  options.duration_s = 30;
  const Simulation stairs = simulate(options, Job()).value();
  const OffsetProblem problem = test::problem_of(stairs.recording);
  const double offset_s = options.offset_s;
  const std::vector<SweepPose> tracked = track(problem, offset_s, MappingOptions(), Job()).value().sweeps;
  const std::vector<SweepPose> walk = adjusted(problem, tracked, offset_s, {}, Job()).sweeps;
  EXPECT_LT(motion_error_m(stairs, walk, 20), 0.5 * motion_error_m(stairs, tracked, 20));
}

// A motion that is the truth may turn back with the motor.
TEST(SolvedWalk, AGivenTruthStaysAsItIs) {
  const Recording& recording = short_walk().recording;
  std::vector<StampedPose> poses;
  for (const TruthPose& pose : short_walk().truth) {
    const double sway_m = 0.03 * recording.motor.angle_at(pose.time_s + 0.024);
    poses.push_back({pose.time_s, pose.position_m + Eigen::Vector3d(0, sway_m, 0), pose.orientation});
  }
  MappingOptions mapping;
  mapping.given = std::make_shared<const GivenMotion>(poses, GivenMotion::Parts::kRotationAndTranslation,
                                                      GivenMotion::Role::kTruth);
  const auto walk = solved_with(mapping);
  ASSERT_TRUE(walk);
  std::size_t followed = 0;
  for (const SweepPose& sweep : walk->sweeps) {
    if (sweep.lost) continue;
    SweepPose given = sweep;
    given.knots = {mapping.given->at(sweep.begin_s), mapping.given->at(sweep.end_s)};
    EXPECT_LT(move_apart_m(sweep, given), 2e-3) << followed;
    ++followed;
  }
  EXPECT_GT(followed, 30u);
}

}  // namespace
}  // namespace sweepscope
