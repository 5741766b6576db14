#include "core/loam/path/given_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/loam/path/guided_path.hpp"
#include "core/loam/path/path_equations.hpp"
#include "core/loam/tracker.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using Parts = GivenMotion::Parts;
using Role = GivenMotion::Role;

// A body that walks, sways and turns at up to 1.5 rad/s.
Pose pose_at(double t_s) {
  const Vector3d turn_rad(0.3 * std::sin(2 * t_s), 0.2 * std::cos(3 * t_s), 1.2 * std::sin(t_s));
  return {rotation_from_vector(turn_rad), {t_s, std::sin(t_s), 0.1 * std::cos(4 * t_s)}};
}

std::vector<StampedPose> sampled(double from_s, double to_s, double step_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; from_s + i * step_s <= to_s; ++i) {
    const double t_s = from_s + i * step_s;
    poses.push_back({t_s, pose_at(t_s).translation_m, pose_at(t_s).rotation});
  }
  return poses;
}

GivenMotion motion(Role role = Role::kPrior, double step_s = 0.02) {
  return GivenMotion(sampled(0, 20, step_s), Parts::kRotationAndTranslation, role);
}

double apart(const Pose& a, const Pose& b) {
  return difference(a, b).norm();
}

// Sweeps that were tracked exactly along the body's motion from 2 to 8 s.
std::vector<SweepPose> tracked_sweeps() {
  std::vector<SweepPose> sweeps(12);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    SweepPose& sweep = sweeps[k];
    sweep.sweep = k;
    sweep.begin_s = 2 + 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.knots.clear();
    for (int i = 0; i <= 20; ++i) sweep.knots.push_back(pose_at(sweep.begin_s + 0.025 * i));
  }
  return sweeps;
}

TEST(GivenMotion, IsNearAMotionOfWhichItHasFewPoses) {
  const GivenMotion given = motion(Role::kPrior, 0.1);
  for (double t_s = 0.5; t_s < 19; t_s += 0.0371) EXPECT_LT(apart(given.at(t_s), pose_at(t_s)), 3e-4) << t_s;
}

// Its rates by finite differences, before and after a pose: the derivative of the rotation vector is right.
TEST(GivenMotion, TurnsOnWithoutAKinkAtItsPoses) {
  constexpr double kSpacing_s = 0.1, kStep_s = 1e-4;
  const GivenMotion given = motion(Role::kPrior, kSpacing_s);
  for (int i = 20; i < 60; ++i) {
    const double t_s = i * kSpacing_s;
    const Vector3d before = difference(given.at(t_s), given.at(t_s - kStep_s)).head<3>() / kStep_s,
                   after = difference(given.at(t_s + kStep_s), given.at(t_s)).head<3>() / kStep_s;
    EXPECT_LT((after - before).norm(), 1e-3 * after.norm()) << t_s;
  }
}

TEST(GivenMotion, ATimeShiftIsAddedToItsStamps) {
  const GivenMotion given = motion().with_time_shift(0.137);
  EXPECT_LT(apart(given.at(5.137), pose_at(5)), 1e-5);
  EXPECT_DOUBLE_EQ(given.begin_s(), 0.137);
  EXPECT_FALSE(given.covers(0.1, 1));
  EXPECT_TRUE(given.covers(0.14, 20.1));
}

TEST(GivenMotion, CoversNoGap) {
  std::vector<StampedPose> poses = sampled(0, 5, 0.02);
  const std::vector<StampedPose> later = sampled(5.5, 10, 0.02);
  poses.insert(poses.end(), later.begin(), later.end());
  const GivenMotion given(poses, Parts::kRotationAndTranslation, Role::kPrior);
  EXPECT_TRUE(given.covers(1, 4.9));
  EXPECT_TRUE(given.covers(5.6, 9));
  EXPECT_FALSE(given.covers(4, 6));
  EXPECT_FALSE(given.covers(5.2, 5.3));
  EXPECT_FALSE(given.covers(9, 10.1));
}

TEST(GivenMotion, RatesAreIntegratedToARotation) {
  std::vector<double> times_s;
  std::vector<Vector3d> rates_rad_s;
  for (int i = 0; i <= 2000; ++i) {
    const double t_s = 0.005 * i, h_s = 1e-4;
    const Pose turn = pose_at(t_s - h_s).inverse() * pose_at(t_s + h_s);
    times_s.push_back(t_s);
    rates_rad_s.push_back(vector_from_rotation(turn.rotation) / (2 * h_s));
  }
  const GivenMotion given = GivenMotion::from_rates(times_s, rates_rad_s);
  EXPECT_FALSE(given.has_translation());
  const Pose expected = pose_at(1).inverse() * pose_at(9), found = given.move(1, 9);
  EXPECT_LT(found.rotation.angularDistance(expected.rotation), 1e-3);
  EXPECT_EQ(found.translation_m, Vector3d::Zero());
}

TEST(GivenMotion, SweepsAlongItDoNotDeviateForwardsNorBackwards) {
  const GivenMotion given = motion();
  const SweepPose sweep = tracked_sweeps()[3];
  for (const Vector6d& twist_per_s : deviation_twists_per_s(sweep, 2, &given, 1))
    EXPECT_LT(twist_per_s.norm(), 1e-3);
  for (const Vector6d& twist_per_s : deviation_twists_per_s(reversed(sweep), 2, &given, -1))
    EXPECT_LT(twist_per_s.norm(), 1e-3);
  EXPECT_GT(deviation_twists_per_s(sweep, 2, nullptr, 1).front().norm(), 0.5);
}

TEST(GuidedPath, WithoutAGivenMotionIsTheSmoothPath) {
  const auto sweeps = tracked_sweeps();
  const GuidedPath path(sweeps, 0.06, nullptr);
  const SmoothPath smooth(sweeps, 0.06);
  EXPECT_EQ(path.blocks(), smooth.knots());
  EXPECT_FALSE(path.shift_block());
  for (const double t_s : {2.1, 3.33, 7.9}) {
    EXPECT_EQ(path.at(t_s).translation_m, smooth.at(t_s).translation_m);
    EXPECT_EQ(path.at(t_s).rotation.coeffs(), smooth.at(t_s).rotation.coeffs());
  }
}

TEST(GuidedPath, DeviatesLittleFromAGoodMotionInAnyFrame) {
  const Pose world_from_map{rotation_from_vector({0.4, -1, 2}), {50, -20, 3}};
  std::vector<StampedPose> poses = sampled(0, 20, 0.02);
  for (StampedPose& pose : poses) {
    const Pose moved = world_from_map * Pose{pose.orientation, pose.position_m};
    pose = {pose.time_s, moved.translation_m, moved.rotation};
  }
  const GivenMotion given(poses, Parts::kRotationAndTranslation, Role::kPrior);
  const auto sweeps = tracked_sweeps();
  const GuidedPath path(sweeps, 0.06, &given);
  ASSERT_TRUE(path.shift_block());
  for (const double t_s : {2.1, 3.33, 7.9}) EXPECT_LT(apart(path.at(t_s), pose_at(t_s)), 1e-3);
  const Eigen::Vector2d of_deviation = jerk(path.deviations(sweeps), 2), of_path = jerk(sweeps, 2);
  EXPECT_LT(of_deviation[0], 0.1 * of_path[0]);
  EXPECT_LT(of_deviation[1], 0.1 * of_path[1]);
}

TEST(GuidedPath, DoesNotUseAMotionThatHasNothingToDoWithTheSweeps) {
  const GivenMotion other = motion().with_time_shift(-7);
  EXPECT_FALSE(GuidedPath(tracked_sweeps(), 0.06, &other).shift_block());
  const GivenMotion elsewhere = motion().with_time_shift(1000);
  EXPECT_FALSE(GuidedPath(tracked_sweeps(), 0.06, &elsewhere).shift_block());
}

// A prior, and the truth, for which the time shift is the only unknown.
class GuidedPathOf : public testing::TestWithParam<Role> {};
INSTANTIATE_TEST_SUITE_P(Roles, GuidedPathOf, testing::Values(Role::kPrior, Role::kTruth));

TEST_P(GuidedPathOf, MovesWithTheTimeShiftAsItsDerivativeSays) {
  const GivenMotion given = motion(GetParam());
  const GuidedPath path(tracked_sweeps(), 0.06, &given);
  EXPECT_EQ(path.knots() == 0, GetParam() == Role::kTruth);
  constexpr double kStep_s = 1e-3;
  const auto shifted = [&](double step_s) {
    GuidedPath moved = path;
    std::vector<Vector6d> steps(path.blocks(), Vector6d::Zero());
    steps[*path.shift_block()][0] = step_s;
    moved.move(steps);
    return moved;
  };
  const GuidedPath later = shifted(kStep_s), earlier = shifted(-kStep_s);
  EXPECT_DOUBLE_EQ(later.time_shift_s(), kStep_s);
  for (const double t_s : {2.5, 4.123, 7.7}) {
    const Vector6d numeric = difference(later.at(t_s), earlier.at(t_s)) / (2 * kStep_s);
    EXPECT_LT((path.place(t_s).per_shift_second - numeric).norm(), 0.01 * numeric.norm()) << t_s;
  }
}

}  // namespace
}  // namespace sweepscope
