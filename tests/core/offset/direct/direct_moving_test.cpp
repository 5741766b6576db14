#include "core/offset/direct/direct_moving.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kMovingTruth_s = 0.024;

class DirectMoving : public testing::Test {
 protected:
  std::optional<MovingDirect> solved(double first_offset_s, const Job& job) const {
    MovingDirectOptions options;
    options.walk = walk_options(MappingOptions(), search_scale(problem_.motor));
    return solve_moving(problem_, first_offset_s, options, job);
  }
  const OffsetProblem problem_ =
      test::problem_of(test::simulated("metro-station", kMovingTruth_s, 20).recording);
};

TEST_F(DirectMoving, AtItsAnswerEIsLeastAndNGreatest) {
  const auto found = solved(kMovingTruth_s - kMs, Job());
  ASSERT_TRUE(found && found->walk->joint);
  EXPECT_TRUE(found->converged);
  const double offset_s = found->walk->joint->offset_s;
  EXPECT_NEAR(offset_s, kMovingTruth_s, 3 * found->walk->joint->sigma_s);
  ASSERT_EQ(found->curve.size(), 3U);
  EXPECT_NEAR(found->curve[0].offset_s, offset_s - 3 * kMs, 1e-12);
  EXPECT_EQ(found->curve[1].offset_s, offset_s);
  EXPECT_NEAR(found->curve[2].offset_s, offset_s + 3 * kMs, 1e-12);
  for (const std::size_t side : {0, 2}) {
    EXPECT_GT(found->curve[side].e_m.value(), found->curve[1].e_m.value()) << side;
    EXPECT_LT(found->curve[side].n.value(), found->curve[1].n.value()) << side;
  }
}

TEST_F(DirectMoving, TracksAgainAtTheOffsetThatFitsUntilItIsNear) {
  const auto found = solved(kMovingTruth_s + 5 * kMs, Job());
  ASSERT_TRUE(found && found->walk->joint);
  EXPECT_TRUE(found->walk->near);
  EXPECT_LT(std::abs(found->walk->tracked_at_s - found->walk->joint->offset_s), kMs);
  EXPECT_NEAR(found->walk->joint->offset_s, kMovingTruth_s, 3 * found->walk->joint->sigma_s);
}

TEST_F(DirectMoving, ACancelledJobHasNoAnswer) {
  Job job;
  job.cancel();
  EXPECT_FALSE(solved(kMovingTruth_s, job));
}

}  // namespace
}  // namespace sweepscope
