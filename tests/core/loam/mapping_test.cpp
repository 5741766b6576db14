#include "core/loam/mapping.hpp"

#include <gtest/gtest.h>

#include "core/offset/direct_moving.hpp"
#include "core/offset/moving.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kMs;

const Vector3d kAxis = Vector3d::UnitX();

// A rig that goes at 0.5 m/s from the first beam on, which the tracker begins to follow as if it stood.
class SteadyWalk : public testing::Test {
 protected:
  static Recording record() {
    test::Bench bench;
    bench.mesh = test::hall();
    bench.duration_s = 8;
    bench.noise_m = 0.01;
    bench.world_from_base = [](double t_s) {
      return Eigen::Isometry3d(Eigen::Translation3d(-2 + 0.5 * t_s, 0.3, 0));
    };
    return bench.record();
  }
  const Recording recording_ = record();
  const OffsetProblem problem_ = test::problem_of(recording_);
  const TrackedWalk walk_ = track(place_sweeps(problem_, 0), kAxis, MappingOptions(), Job()).value();
};

TEST_F(SteadyWalk, StepsComeOutEqual) {
  ASSERT_GE(walk_.sweeps.size(), 14u);
  EXPECT_FALSE(walk_.lost);
  for (std::size_t k = 3; k + 1 < walk_.sweeps.size(); ++k) {
    const SweepPose &before = walk_.sweeps[k - 1], &after = walk_.sweeps[k];
    const double lasted_s = (after.begin_s + after.end_s - before.begin_s - before.end_s) / 2;
    const Vector3d step_m = after.middle().translation_m - before.middle().translation_m;
    EXPECT_NEAR(step_m.x() / lasted_s, 0.5, 0.05) << k;
    EXPECT_NEAR(step_m.tail<2>().norm(), 0, 0.02) << k;
  }
}

TEST_F(SteadyWalk, TheWayIsAsLongAsItWas) {
  const SweepPose &first = walk_.sweeps.front(), &last = walk_.sweeps.back();
  const Vector3d way_m = last.end.translation_m - first.begin.translation_m;
  EXPECT_NEAR((way_m - Vector3d(0.5 * (last.end_s - first.begin_s), 0, 0)).norm(), 0, 0.05);
}

TEST_F(SteadyWalk, WithinASweepTheRigMovesToo) {
  for (std::size_t k = 3; k + 1 < walk_.sweeps.size(); ++k) {
    const SweepPose& sweep = walk_.sweeps[k];
    const double moved_m = (sweep.end.translation_m - sweep.begin.translation_m).x();
    EXPECT_NEAR(moved_m / (sweep.end_s - sweep.begin_s), 0.5, 0.1) << k;
  }
}

// A minute through the metro station at a true offset of 24 ms.
class Walk : public testing::Test {
 protected:
  CurvePoint candidate(double off_s) const {
    return moving_candidate(problem_, 0.024 + off_s, Scoring::kTwoStage, MappingOptions(), Job());
  }
  const Recording& recording_ = test::simulated("metro-station", 0.024, 60).recording;
  const OffsetProblem problem_ = test::problem_of(recording_);
};

TEST_F(Walk, ARollThatAlternatesTellsHowFarTheOffsetIsOff) {
  const CurvePoint below = candidate(-2 * kMs), above = candidate(2 * kMs);
  const double slope = (*above.signed_rotation_rad - *below.signed_rotation_rad) / (4 * kMs);
  EXPECT_NEAR(slope / (2 * problem_.motor.median_speed_rad_s), 1, 0.15);
  const MovingPass truth = moving_pass(problem_, 0.024, MappingOptions(), Job());
  const double sigma_s = sigma_of_roll(truth.sweep_roll_rad).value() / slope;
  EXPECT_LT(sigma_s, 0.1 * kMs);
  EXPECT_NEAR(truth.roll_rad / slope, 0, 3 * sigma_s);
}

TEST_F(Walk, FiveMillisecondsOffTheMeanDistanceIsClearlyLarger) {
  const CurvePoint truth = candidate(0), off = candidate(5 * kMs);
  EXPECT_GT(*off.e_m, 1.3 * *truth.e_m);
  EXPECT_LT(*off.n, *truth.n);
}

TEST(Track, ACancelledJobIsInterrupted) {
  Job job;
  job.cancel();
  const auto result = track(std::vector<PlacedSweep>(2), kAxis, MappingOptions(), job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::kInterrupted);
}

// Sweeps whose roll about the motor's axis is `roll_rad(k)`, on a path that turns and climbs besides.
template <typename Roll>
std::vector<SweepPose> rolling(std::size_t count, const Roll& roll_rad) {
  std::vector<SweepPose> sweeps(count);
  for (std::size_t k = 0; k < count; ++k) {
    sweeps[k].direction = k % 2 == 0 ? 1 : -1;
    const Pose pose{rotation_from_vector(roll_rad(k) * kAxis), {0.3 * double(k), 0.1, 0.02 * double(k)}};
    sweeps[k].begin = sweeps[k].end = pose;
  }
  return sweeps;
}

double quadratic_rad(std::size_t k) {
  return 0.1 + 0.004 * double(k) - 0.0003 * double(k * k);
}

void expect_quadratic(const std::vector<SweepPose>& sweeps) {
  for (std::size_t k = 0; k < sweeps.size(); ++k)
    for (const Pose& pose : {sweeps[k].begin, sweeps[k].end})
      EXPECT_NEAR(vector_from_rotation(pose.rotation).x(), quadratic_rad(k), 1e-12) << k;
}

TEST(AlternatingRoll, IsTakenOutExactlyAndAQuadraticRollIsKept) {
  const auto sweeps =
      rolling(30, [](std::size_t k) { return quadratic_rad(k) + (k % 2 == 0 ? -0.007 : 0.007); });
  const AlternatingRoll found = take_out_alternating_roll(sweeps, kAxis, 8);
  EXPECT_NEAR(found.signed_rotation_rad, 0.014, 1e-12);  // from one sweep to the next
  expect_quadratic(found.sweeps);
}

TEST(AlternatingRoll, IsNothingWhereTheRollIsSmooth) {
  const AlternatingRoll found = take_out_alternating_roll(rolling(30, quadratic_rad), kAxis, 8);
  EXPECT_NEAR(found.signed_rotation_rad, 0, 1e-12);
  expect_quadratic(found.sweeps);
}

TEST(AlternatingRoll, OneSweepThatSlippedDoesNotCount) {
  auto sweeps = rolling(80, quadratic_rad);
  sweeps[30].begin.rotation = sweeps[30].end.rotation =
      rotation_from_vector({0.5, 0, 0}) * sweeps[30].begin.rotation;
  EXPECT_NEAR(take_out_alternating_roll(sweeps, kAxis, 8).signed_rotation_rad, 0, 1e-9);
}

TEST(AlternatingRoll, PlacesStayWhereTheyWere) {
  const auto sweeps = rolling(20, [](std::size_t k) { return k % 2 == 0 ? -0.01 : 0.01; });
  const AlternatingRoll found = take_out_alternating_roll(sweeps, kAxis, 8);
  for (std::size_t k = 0; k < sweeps.size(); ++k)
    EXPECT_EQ(found.sweeps[k].begin.translation_m, sweeps[k].begin.translation_m);
}

}  // namespace
}  // namespace sweepscope
