#include "core/results/rig_parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/results/rig_json.hpp"
#include "tests/core/results/solved_rig_by_hand.hpp"

namespace sweepscope {
namespace {

RigParameter named(const std::vector<RigParameter>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &RigParameter::name);
  return found == all.end() ? RigParameter() : *found;
}

TEST(RigParameters, AreThoseOfThePartsThatWereSolvedFor) {
  const auto all = rig_parameters(test::solved_rig_by_hand());
  ASSERT_EQ(all.size(), 9U);
  EXPECT_EQ(all.front().name, "mount roll");
  EXPECT_EQ(all.back().name, "encoder phase");
  SolvedRig of_play;
  of_play.play.solved = true;
  ASSERT_EQ(rig_parameters(of_play).size(), 1U);
}

TEST(RigParameters, HaveValueSigmaPriorAndUnit) {
  const auto all = rig_parameters(test::solved_rig_by_hand());
  const RigParameter pitch = named(all, "mount pitch");
  EXPECT_EQ(pitch.state, RigParameter::State::kFound);
  EXPECT_EQ(in_words(pitch), "3.0021 ± 0.0040°");
  EXPECT_NEAR(*pitch.prior, 20, 1e-9);
  EXPECT_EQ(in_words(named(all, "mount yaw")), "−1.5000 ± 0.0040°");
  EXPECT_EQ(in_words(named(all, "mount y")), "12.50 ± 0.21 mm");
  EXPECT_EQ(in_words(named(all, "encoder amplitude")), "0.300 ± 0.010°");
  EXPECT_EQ(in_words(named(all, "encoder phase")), "40.0 ± 1.9°");
}

TEST(RigParameters, AlongTheMotorsAxisTheMountIsKept) {
  const auto all = rig_parameters(test::solved_rig_by_hand());
  for (const char* name : {"mount roll", "mount x"}) {
    EXPECT_EQ(named(all, name).state, RigParameter::State::kGauge) << name;
    EXPECT_FALSE(named(all, name).sigma) << name;
  }
  EXPECT_EQ(in_words(named(all, "mount x")), "0.00 mm, kept");
}

TEST(RigParameters, WhatIsNotDeterminedHasTheRigFilesValueAndAReason) {
  const SolvedRig solved = test::solved_rig_by_hand();
  const RigParameter play = named(rig_parameters(solved), "gear play");
  EXPECT_EQ(play.state, RigParameter::State::kNotDetermined);
  EXPECT_EQ(play.found, 0.2);
  EXPECT_FALSE(play.sigma);
  EXPECT_EQ(in_words(play), "not determined");
  EXPECT_EQ(reasons_of(solved), std::vector<std::string>{"The motor turns at one speed only."});
}

TEST(RigParameters, AreReadBackFromJson) {
  SolvedRig solved = test::solved_rig_by_hand();
  solved.covariance(kTurnU, kTurnV) = solved.covariance(kTurnV, kTurnU) =
      0.25 * solved.covariance(kTurnU, kTurnU);
  solved.residual_before_m = 0.012;
  solved.residual_after_m = 0.008;
  solved.points = 5000;
  const auto json = rig_parameters_json(solved);
  const auto back = solved_rig_of(json);
  ASSERT_TRUE(back);
  EXPECT_EQ(rig_parameters_json(*back).dump(), json.dump());
  const auto as_read = rig_parameters(*back), as_solved = rig_parameters(solved);
  ASSERT_EQ(as_read.size(), as_solved.size());
  for (std::size_t i = 0; i < as_read.size(); ++i) {
    EXPECT_EQ(as_read[i].name, as_solved[i].name);
    EXPECT_EQ(in_words(as_read[i]), in_words(as_solved[i])) << as_read[i].name;
  }
  EXPECT_EQ(reasons_of(*back), reasons_of(solved));
}

TEST(RigParameters, OfAWalkAreReadBackWithAShiftThatIsNotDetermined) {
  SolvedRig solved = test::solved_rig_by_hand();
  solved.along_walk = true;
  const auto back = solved_rig_of(rig_parameters_json(solved));
  ASSERT_TRUE(back);
  EXPECT_EQ(in_words(named(rig_parameters(*back), "mount y")), "not determined");
  EXPECT_EQ(in_words(named(rig_parameters(*back), "mount pitch")), "3.0021 ± 0.0040°");
}

TEST(RigParameters, OfOlderOrBrokenJsonAreAbsent) {
  auto older = rig_parameters_json(test::solved_rig_by_hand());
  older["correlation"].erase("sigma");
  EXPECT_FALSE(solved_rig_of(older));
  auto broken = rig_parameters_json(test::solved_rig_by_hand());
  broken["correlation"]["matrix"].erase(3);
  EXPECT_FALSE(solved_rig_of(broken));
  EXPECT_FALSE(solved_rig_of(nlohmann::ordered_json::array()));
}

}  // namespace
}  // namespace sweepscope
