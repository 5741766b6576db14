#include "core/offset/walk/ways.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A walk at 1 m/s that creeps between two times.
SolvedWalk walk_that_creeps(double from_s, double to_s, double misfit_m) {
  SolvedWalk walk;
  walk.misfit_m = misfit_m;
  const auto at = [&](double t_s) {
    constexpr double kMissing_mps = 0.9;
    return Pose{Eigen::Quaterniond::Identity(),
                Vector3d(t_s - kMissing_mps * (std::clamp(t_s, from_s, to_s) - from_s), 0, 0)};
  };
  for (std::size_t k = 0; k < 40; ++k) {
    SweepPose& sweep = walk.sweeps.emplace_back();
    sweep.sweep = k;
    sweep.begin_s = 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.knots = {at(sweep.begin_s), at(sweep.end_s)};
  }
  return walk;
}

std::string contradiction(const WalkWays& ways, std::size_t of) {
  Recording recording;
  recording.scans.resize(1);
  return contradiction_of(ways.walks[of], ways, 0.3, recording);
}

TEST(Ways, AMotionThatAnotherWayFoundIsNotContradicted) {
  const WalkWays ways = {
      {walk_that_creeps(8, 12, 0.05), walk_that_creeps(0, 0, 0.04), walk_that_creeps(0, 0, 0.04)}, 3};
  EXPECT_EQ(contradiction(ways, 1), "");
  EXPECT_NE(contradiction(ways, 0).find("From 8 to 12 s"), std::string::npos) << contradiction(ways, 0);
  EXPECT_NE(contradiction(ways, 0).find("it ends 3.6 m apart"), std::string::npos) << contradiction(ways, 0);
}

TEST(Ways, TheFirstAndTheLastSweepAloneAreNoContradiction) {
  const SolvedWalk right = walk_that_creeps(0, 0, 0.04);
  SolvedWalk lost_ends = right, lost_more = right;
  lost_ends.sweeps.front().lost = lost_ends.sweeps.back().lost = true;
  lost_more.sweeps[0].lost = lost_more.sweeps[1].lost = true;
  for (SolvedWalk* walk : {&lost_ends, &lost_more}) {
    walk->sweeps.front().knots.front().translation_m.x() -= 5;
    walk->sweeps.back().knots.back().translation_m.x() += 5;
  }
  EXPECT_EQ(contradiction({{lost_ends, right, right}, 3}, 0), "");
  EXPECT_NE(contradiction({{lost_more, right, right}, 3}, 0).find("From 0 to 1 s"), std::string::npos);
}

// It was tracked from sweeps of another one.
TEST(Ways, AFurtherWayConfirmsNothing) {
  const SolvedWalk creeping = walk_that_creeps(8, 12, 0.05), right = walk_that_creeps(0, 0, 0.03);
  EXPECT_EQ(contradiction({{creeping, right, creeping, right}, 3}, 3), "") << "the second way found the same";
  EXPECT_NE(contradiction({{creeping, creeping, creeping, right, right}, 3}, 3), "");
}

TEST(Ways, SweepsThatTwoWaysAgreeAboutAreCertain) {
  const KnownSweeps known = certain_sweeps(
      {{walk_that_creeps(4, 6, 0.06), walk_that_creeps(0, 0, 0.05), walk_that_creeps(4, 8, 0.07)}, 3});
  EXPECT_EQ(known.first, 12u);
  ASSERT_EQ(known.poses.size(), 28u);
  EXPECT_EQ(known.poses.front().sweep, 12u);
  EXPECT_NEAR(known.poses.front().begin().translation_m.x(), 6, 1e-9) << "as the best fitting way placed it";
  EXPECT_TRUE(
      certain_sweeps({{walk_that_creeps(0, 20, 0.06), walk_that_creeps(0, 0, 0.05)}, 2}).poses.empty());
}

TEST(FindWalk, ATrajectoryIsTrackedAtTheSameOffsetButLeavesTheOffsetUnaveraged) {
  const OffsetProblem problem = test::problem_of(test::simulated("metro-station", 0.024, 20).recording);
  const auto offset = find_walk(problem, 0.024, {}, WalkPurpose::kOffset, Job());
  const auto trajectory = find_walk(problem, 0.024, {}, WalkPurpose::kTrajectory, Job());
  ASSERT_TRUE(offset && trajectory && offset->joint && trajectory->joint);
  EXPECT_TRUE(offset->joint->converged);
  EXPECT_FALSE(trajectory->joint->converged);
  EXPECT_NEAR(trajectory->tracked_at_s, offset->tracked_at_s, 0.5e-3);
}

}  // namespace
}  // namespace sweepscope
