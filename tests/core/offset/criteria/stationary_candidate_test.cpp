#include "core/offset/criteria/stationary_candidate.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kStationaryTruth_s = 0.024;

// 9 s in a room.
class Room : public testing::Test {
 protected:
  std::vector<PairMotion> pairs(double off_s) const {
    return pair_motions(problem_, kStationaryTruth_s + off_s, OdometryOptions());
  }
  CurvePoint candidate(double off_s, const std::vector<std::size_t>& of_pairs, double weight_c = 1) const {
    return stationary_candidate(problem_, kStationaryTruth_s + off_s, of_pairs, weight_c, OdometryOptions());
  }
  const Recording& recording_ = test::simulated("room-1", kStationaryTruth_s, 9, 0.513).recording;
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

}  // namespace
}  // namespace sweepscope
