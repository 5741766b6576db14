#include "core/rig_solve/rig_residuals.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "core/offset/estimator.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

constexpr double kFoundOffset_s = 0.017;

Recording in_room(const Eigen::Vector3d& mount_error_deg) {
  SimulationOptions options;
  options.scene = "room-2";
  options.offset_s = kFoundOffset_s;
  options.duration_s = 6;
  options.mount_error_deg = mount_error_deg;
  return simulate(options, Job()).value().recording;
}

const Recording& unturned_rig() {
  static const Recording recording = in_room({0, 0, 0});
  return recording;
}

RigUnknowns at_offset() {
  RigUnknowns rig;
  rig.offset_s = kFoundOffset_s;
  return rig;
}

// What the perfect rig's recording shows with a mount turned by `turn_rad`, and with the true one.
RigResiduals residuals_of_turn(const Eigen::Vector2d& turn_rad) {
  const PreparedRecording prepared = prepare(unturned_rig(), FeatureOptions(), Job()).value();
  RigUnknowns wrong = at_offset();
  wrong.turn_rad = turn_rad;
  return rig_residuals(problem_for(prepared, kFoundOffset_s, kFoundOffset_s), wrong, at_offset(),
                       {.loss_width_m = 0.012});
}

TEST(RigResiduals, AWrongMountIsAPatternThatTheTrueOneDoesNotHave) {
  const RigResiduals seen = residuals_of_turn({0.03, -0.02});
  EXPECT_GT(seen.before.rms_m(), 0.01);
  EXPECT_LT(seen.after.rms_m(), 0.2 * seen.before.rms_m());
}

TEST(RigResiduals, TheSameRigTwiceGivesTheSameGridTwice) {
  const RigResiduals seen = residuals_of_turn({0, 0});
  ASSERT_FALSE(seen.after.empty());
  EXPECT_EQ(std::memcmp(seen.before.residual_m.data(), seen.after.residual_m.data(),
                        seen.after.residual_m.size() * sizeof(double)),
            0);
}

TEST(RigResiduals, TheGridSpansTheMotorsAnglesAndTheBeams) {
  const ResidualGrid grid = residuals_of_turn({0, 0}).after;
  EXPECT_EQ(grid.residual_m.size(), grid.columns * grid.rows);
  EXPECT_NEAR(grid.motor.from_rad, -M_PI / 2, 0.1);
  EXPECT_NEAR(grid.motor.to_rad, M_PI / 2, 0.1);
  EXPECT_NEAR(grid.beam.from_rad, -M_PI / 2, 0.1);
  EXPECT_NEAR(grid.beam.to_rad, M_PI / 2, 0.1);
}

TEST(RigResiduals, ASolvedRigHoldsThoseOfTheRigFileAndOfWhatWasFound) {
  const Recording recording = in_room({0, 3, -2});
  EstimateOptions options;
  options.solve.mount = true;
  const RigResiduals residuals = estimate(recording, options, Job()).value().rig->residuals;
  EXPECT_GT(residuals.before.rms_m(), 5 * residuals.after.rms_m());
}

TEST(RigResiduals, AreTheSameToTheByteForOneAndForManyThreads) {
  const auto bytes = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const RigResiduals seen = residuals_of_turn({0.03, 0});
    std::string text(seen.before.residual_m.size() * sizeof(double), '\0');
    std::memcpy(text.data(), seen.before.residual_m.data(), text.size());
    return text;
  };
  EXPECT_EQ(bytes(1), bytes(4));
}

TEST(RigResiduals, WithoutAnySurfaceThereIsNoGrid) {
  const PreparedRecording prepared = prepare(unturned_rig(), FeatureOptions(), Job()).value();
  OffsetProblem problem = problem_for(prepared, kFoundOffset_s, kFoundOffset_s);
  std::ranges::fill(problem.scan_used, 0);
  EXPECT_TRUE(rig_residuals(problem, at_offset(), at_offset(), {}).before.empty());
}

}  // namespace
}  // namespace sweepscope
