#include "core/offset/walk/walk.hpp"

#include <gtest/gtest.h>

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

TEST(SolvedWalk, IsTheTrackedOneStraightened) {
  const OffsetProblem problem = test::problem_of(short_walk().recording);
  const auto walk = solved_with({});
  ASSERT_TRUE(walk);
  const TrackedWalk tracked = track(problem, walk->tracked_at_s, MappingOptions(), Job()).value();
  const std::vector<SweepPose> straight = straightened(tracked.sweeps);
  ASSERT_EQ(walk->sweeps.size(), straight.size());
  double changed_m = 0;
  for (std::size_t k = 0; k < straight.size(); ++k) {
    EXPECT_LT(move_apart_m(walk->sweeps[k], straight[k]), 1e-9) << k;
    changed_m = std::max(changed_m, move_apart_m(tracked.sweeps[k], straight[k]));
  }
  EXPECT_GT(changed_m, 1e-4);
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
