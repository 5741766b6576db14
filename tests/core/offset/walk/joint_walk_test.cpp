#include "core/offset/walk/joint_walk.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/offset/direct/direct_moving.hpp"
#include "core/offset/estimator.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

std::optional<JointWalk> solved(const Recording& recording, double offset_s,
                                const JointWalkOptions& options = {}) {
  const OffsetProblem problem = test::problem_of(recording);
  const TrackedWalk tracked = track(problem, offset_s, options.mapping, Job()).value();
  return solve_joint_walk(problem, tracked.sweeps, offset_s, options, Job());
}

// From where it starts, the walk tracked there included, to the truth.
class JointWalkFrom : public testing::TestWithParam<double> {};

TEST_P(JointWalkFrom, FindsTheTruth) {
  const auto walk = solved(test::simulated("metro-station", 0.024, 40).recording, 0.024 + GetParam());
  ASSERT_TRUE(walk);
  EXPECT_TRUE(walk->converged);
  EXPECT_EQ(walk->parts.size(), 4u);
  EXPECT_NEAR(walk->offset_s, 0.024, 3 * walk->sigma_s);
  EXPECT_LT(walk->sigma_s, 0.15 * kMs);
  EXPECT_GT(walk->lever_m, 0.1 * walk->reach_m);
}

INSTANTIATE_TEST_SUITE_P(Starts, JointWalkFrom, testing::Values(-1.5 * kMs, 0.0, 1.5 * kMs));

TEST(JointWalk, PosesAreContinuousAndOneForEverySweep) {
  const Recording& recording = test::simulated("metro-station", 0.024, 20).recording;
  const OffsetProblem problem = test::problem_of(recording);
  const TrackedWalk tracked = track(problem, 0.024, MappingOptions(), Job()).value();
  JointWalkOptions options;
  options.part_s = 1000;
  const auto walk = solve_joint_walk(problem, tracked.sweeps, 0.024, options, Job());
  ASSERT_TRUE(walk);
  ASSERT_EQ(walk->sweeps.size(), tracked.sweeps.size());
  for (std::size_t k = 1; k < walk->sweeps.size(); ++k) {
    EXPECT_EQ(walk->sweeps[k].sweep, tracked.sweeps[k].sweep);
    const Pose gap = walk->sweeps[k - 1].end().inverse() * walk->sweeps[k].begin();
    EXPECT_LT(gap.translation_m.norm(), 2e-3) << k;
    EXPECT_LT(vector_from_rotation(gap.rotation).norm(), 2e-3) << k;
  }
}

TEST(JointWalk, TheSameForOneAndTwoThreads) {
  const auto with = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return *solved(test::simulated("metro-station", 0.024, 40).recording, 0.0245);
  };
  const JointWalk one = with(1), two = with(2);
  EXPECT_EQ(one.offset_s, two.offset_s);
  EXPECT_EQ(one.sigma_s, two.sigma_s);
}

TEST(JointWalk, WithoutMatchesThereIsNone) {
  JointWalkOptions options;
  options.min_matches = 1000000;
  EXPECT_FALSE(solved(test::simulated("metro-station", 0.024, 40).recording, 0.024, options));
}

TEST(JointWalk, ClocksThatDriftApartAreRefusedAndMeasured) {
  SimulationOptions options;
  options.scene = "metro-station";
  options.duration_s = 45;
  options.clock_drift_ppm = 80;
  EstimateOptions direct;
  direct.method = Method::kDirect;
  const auto found = estimate(simulate(options, Job())->recording, direct, Job());
  EXPECT_FALSE(found->identifiable);
  EXPECT_NEAR(found->drift_ppm.value_or(0), 80, 15);
  const auto says = [](const std::string& text) { return text.find("drift apart") != text.npos; };
  EXPECT_TRUE(std::ranges::any_of(found->reasons(), says)) << testing::PrintToString(found->reasons());
}

// A stride takes 1.11 s: with sweeps of half of it, the wearer's sway alternates as a wrong offset's roll
// does.
TEST(JointWalk, ASwayInStepWithTheMotorIsSaidAndWidensSigma) {
  EstimateOptions options;
  options.method = Method::kDirect;
  const auto found = estimate(test::simulated("parking-area", 0.024, 30, 0.556).recording, options, Job());
  ASSERT_TRUE(found->identifiable) << testing::PrintToString(found->reasons());
  EXPECT_NEAR(*found->offset_s, 0.024, 3 * *found->sigma_s);
  EXPECT_GT(*found->sigma_s, 0.2 * kMs);
  const auto says = [](const std::string& text) { return text.find("in step with the motor") != text.npos; };
  EXPECT_TRUE(std::any_of(found->warnings.begin(), found->warnings.end(), says))
      << testing::PrintToString(found->warnings) << *found->offset_s << " " << *found->sigma_s;
}

// Such a motor's offset turns the map as a swaying body does: sigma is larger than that of a motor that turns
// evenly.
TEST(JointWalk, ASineMotorsSigmaKnowsThatASwayLooksLikeAnOffset) {
  for (const std::uint64_t seed : {1, 2}) {
    SimulationOptions options{.scene = "metro-station", .offset_s = 0.0137, .seed = seed, .duration_s = 25};
    options.motor = simulation::MotorKind::kSine;
    const auto walk = solved(simulate(options, Job())->recording, 0.0137);
    ASSERT_TRUE(walk);
    EXPECT_NEAR(walk->offset_s, 0.0137, 2 * walk->sigma_s);
    EXPECT_GT(walk->sigma_s, 0.2 * kMs);
    EXPECT_LT(walk->sigma_s, 1.5 * kMs);
  }
}

}  // namespace
}  // namespace sweepscope
