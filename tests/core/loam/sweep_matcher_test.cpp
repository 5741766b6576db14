#include "core/loam/sweep_matcher.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

constexpr double kGate_m = 0.1, kCap_m = 0.3;

MatchResidual residual_m(double distance_m) {
  return {Eigen::Vector3d::UnitZ(), distance_m};
}

// Nine features of the floor 2 m away that match wherever the rig is, and one of a pillar 18 m away.
MatchCount seen(const std::optional<MatchResidual>& pillar) {
  MatchCount count;
  for (int i = 0; i < 9; ++i) count.add(residual_m(0.01), 2, kGate_m, kCap_m);
  count.add(pillar, 18, kGate_m, kCap_m);
  return count;
}

TEST(MatchCount, WhatIsFarCountsAsMuchAsTheManyFeaturesThatAreNear) {
  const MatchCount follows = seen(residual_m(0.01)), stands = seen(std::nullopt);
  EXPECT_EQ(stands.matches, 9u);
  EXPECT_DOUBLE_EQ(follows.matched_part(), 1);
  EXPECT_DOUBLE_EQ(stands.matched_part(), 0.5);
  EXPECT_DOUBLE_EQ(follows.misfit_m(), 0.01);
  EXPECT_DOUBLE_EQ(stands.misfit_m(), (0.01 + kCap_m) / 2);
}

TEST(MatchCount, CountsOfTheCriteriaHaveNoWeights) {
  const MatchCount count = seen(residual_m(0.2));
  EXPECT_EQ(count.features, 10u);
  EXPECT_DOUBLE_EQ(count.mean_distance_m(), 0.01);
  EXPECT_DOUBLE_EQ(count.capped_cost_m(), (9 * 0.01 + 0.2) / 10);
}

TEST(MatchCount, SumsAddUp) {
  MatchCount twice = seen(std::nullopt);
  twice += seen(residual_m(0.01));
  EXPECT_DOUBLE_EQ(twice.matched_part(), 0.75);
  EXPECT_DOUBLE_EQ(twice.misfit_m(), (0.01 + (0.01 + kCap_m) / 2) / 2);
}

TEST(MatchCount, OfNothingIsZero) {
  EXPECT_EQ(MatchCount().matched_part(), 0);
  EXPECT_EQ(MatchCount().misfit_m(), 0);
}

}  // namespace
}  // namespace sweepscope
