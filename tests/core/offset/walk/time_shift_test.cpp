#include "core/offset/walk/time_shift.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/loam/path/given_motion.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// Turns that do not repeat themselves within a minute.
Pose turning_pose_at(double t_s) {
  const Vector3d turn_rad(0.2 * std::sin(2.1 * t_s + std::sin(0.3 * t_s)), 0.1 * std::sin(1.3 * t_s),
                          0.5 * std::sin(0.7 * t_s + 0.02 * t_s * t_s));
  return {rotation_from_vector(turn_rad), Vector3d::Zero()};
}

GivenMotion motion(double from_s, double to_s, double shift_s) {
  std::vector<StampedPose> poses;
  for (double t_s = from_s; t_s < to_s; t_s += 0.01)
    poses.push_back({t_s - shift_s, Vector3d::Zero(), turning_pose_at(t_s).rotation});
  return GivenMotion(poses, GivenMotion::Parts::kRotation, GivenMotion::Role::kPrior);
}

// Tracked from 10 to 30 s; every sweep is turned to and fro about x, as a wrong offset does it.
std::vector<SweepPose> sweeps(double alternation_rad) {
  std::vector<SweepPose> tracked(40);
  for (std::size_t k = 0; k < tracked.size(); ++k) {
    SweepPose& sweep = tracked[k];
    sweep.begin_s = 10 + 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.stretch = 1;
    const Pose turned{rotation_from_vector((k % 2 == 0 ? 1 : -1) * alternation_rad * Vector3d::UnitX()),
                      Vector3d::Zero()};
    sweep.knots.clear();
    for (int i = 0; i <= 20; ++i) sweep.knots.push_back(turning_pose_at(sweep.begin_s + 0.025 * i) * turned);
  }
  return tracked;
}

// A shift within the recording, and clocks that have nothing in common.
class TimeShiftOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Clocks, TimeShiftOf, testing::Values(0.0, 0.137, -3.21, 1e5));

TEST_P(TimeShiftOf, IsFoundFromTheTurns) {
  const auto found = correlate_turns(sweeps(0.01), motion(0, 40, GetParam()));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->clear);
  EXPECT_NEAR(found->shift.time_s, GetParam(), 3e-3);
}

TEST(TimeShift, OfTurnsWithoutNoiseIsExact) {
  const auto found = correlate_turns(sweeps(0), motion(0, 40, 0.137));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->shift.time_s, 0.137, 2e-4);
}

TEST(TimeShift, IsNotClearWhereNothingTurnsOrTheTurnsAreOthers) {
  std::vector<StampedPose> still{{0, Vector3d::Zero(), Eigen::Quaterniond::Identity()}};
  for (int i = 1; i < 400; ++i) still.push_back({0.1 * i, Vector3d::Zero(), Eigen::Quaterniond::Identity()});
  const GivenMotion standing(still, GivenMotion::Parts::kRotation, GivenMotion::Role::kPrior);
  const auto found = correlate_turns(sweeps(0), standing);
  EXPECT_FALSE(found && found->clear);
}

TEST(TimeShift, OfShortOverlapsIsAbsentOrNotClear) {
  std::vector<SweepPose> lost = sweeps(0);
  for (SweepPose& sweep : lost) sweep.lost = true;
  EXPECT_FALSE(correlate_turns(lost, motion(0, 40, 0)));
}

TEST(TimeShift, TheMeanOfPartsThatScatterIsLessCertain) {
  const TimeShift close = mean_of({{0.1, 1e-3}, {0.1005, 1e-3}, {0.0995, 1e-3}});
  const TimeShift apart = mean_of({{0.1, 1e-3}, {0.11, 1e-3}, {0.09, 1e-3}});
  EXPECT_NEAR(close.time_s, 0.1, 1e-9);
  EXPECT_NEAR(apart.time_s, 0.1, 1e-9);
  EXPECT_GT(apart.sigma_s, 3 * close.sigma_s);
}

}  // namespace
}  // namespace sweepscope
