// Offsets of motors that turn one way, against the truth of simulated recordings.
#include <gtest/gtest.h>

#include "core/offset/estimator.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

SimulationOptions one_way(const char* scene, std::uint64_t seed, std::vector<double> speeds_dps) {
  SimulationOptions options;
  options.scene = scene;
  options.seed = seed;
  options.motor = simulation::MotorKind::kOneWay;
  options.speeds_dps = std::move(speeds_dps);
  options.duration_s = 10;
  options.offset_s = (24.3 - double(seed) * 7.1) * kMs;
  return options;
}

Estimate found_in(const SimulationOptions& made, const EstimateOptions& options = {}) {
  return estimate(simulate(made, Job()).value().recording, options, Job()).value();
}

void expect_truth(const SimulationOptions& made, double max_error_s) {
  const Estimate found = found_in(made);
  EXPECT_EQ(found.kind, RigKind::kStationary);
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, made.offset_s, max_error_s);
  EXPECT_NEAR(*found.offset_s, made.offset_s, 3 * *found.sigma_s);
}

bool says(const Estimate& estimate, const char* words) {
  return std::ranges::any_of(
      estimate.reasons(), [&](const std::string& reason) { return reason.find(words) != std::string::npos; });
}

TEST(OneWay, TwoSpeedsTellTheOffset) {
  expect_truth(one_way("room-1", 1, {360, 180}), 0.1 * kMs);
  expect_truth(one_way("room-4", 2, {170, 350}), 0.1 * kMs);
}

TEST(OneWay, ARampTellsTheOffset) {
  SimulationOptions made = one_way("room-3", 3, {360, 150});
  made.speed_ramp = true;
  expect_truth(made, 0.15 * kMs);
}

TEST(OneWay, TheEncodersZeroDoesNotMatter) {
  const SimulationOptions made = one_way("room-1", 1, {360, 180});
  Recording recording = simulate(made, Job()).value().recording;
  for (double& angle_rad : recording.motor.angle_rad) angle_rad += 1;
  const Estimate found = estimate(recording, {}, Job()).value();
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  EXPECT_NEAR(*found.offset_s, made.offset_s, 0.1 * kMs);
}

TEST(OneWay, OneSpeedIsRefusedWithTheWayToRecordIt) {
  for (const double speed_dps : {360.0, 210.0}) {
    const Estimate refused = found_in(one_way("room-2", 5, {speed_dps}));
    EXPECT_FALSE(refused.identifiable);
    EXPECT_TRUE(says(refused, "Record 5 s at one speed and 5 s at half of it."));
  }
}

TEST(OneWay, TheMotorsOwnUnevennessIsNoSecondSpeed) {
  SimulationOptions made = one_way("room-2", 6, {360});
  made.uneven_motor = 0.05;
  made.eccentricity_deg = 1;
  EXPECT_TRUE(says(found_in(made), "at one speed"));
}

TEST(OneWay, AMovingRigIsRefused) {
  SimulationOptions made = one_way("metro-station", 1, {360, 180});
  const Estimate refused = found_in(made);
  EXPECT_EQ(refused.kind, RigKind::kMoving);
  EXPECT_TRUE(says(refused, "its motor turns one way"));
}

TEST(OneWay, ThePapersCriteriaAreRefused) {
  EstimateOptions options;
  options.method = Method::kStationary;
  EXPECT_TRUE(
      says(found_in(one_way("room-1", 1, {360, 180}), options), "Use the direct method (--method direct)."));
}

TEST(OneWay, ARigThatIsPushedAsideIsRefusedOrTakenToMove) {
  SimulationOptions made = one_way("room-1", 4, {360, 180});
  made.nudge_m = 0.2;
  EXPECT_FALSE(found_in(made).identifiable);
}

}  // namespace
}  // namespace sweepscope
