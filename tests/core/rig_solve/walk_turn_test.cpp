#include "core/rig_solve/walk_turn.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/rig_solve/rig_unknowns.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

constexpr double kSwing_s = 0.5, kClock_s = 0.012;

// The encoder swings between -90 and 90 deg, its clock ahead.
double triangle_rad(double t_s) {
  const double phase = std::fmod(t_s + 100 * kSwing_s, 2 * kSwing_s) / kSwing_s;
  return test::kPi * (phase < 1 ? phase - 0.5 : 1.5 - phase);
}

// A body that turns and sways at its own pace.
Eigen::Quaterniond walking(double t_s) {
  return rotation_from_vector(
      {0.05 * std::sin(5.1 * t_s), 0.04 * std::cos(7.3 * t_s), 0.8 * std::sin(0.6 * t_s)});
}

// What is solved for of a walk whose mount is turned: the path takes up the turn.
struct Walked {
  Recording recording;
  std::vector<SweepPose> sweeps;

  Walked(const Eigen::Vector3d& axis, const Eigen::Vector2d& turn_rad, double duration_s) {
    recording.rig.mount.axis = axis;
    recording.motor =
        test::track_of([](double t_s) { return triangle_rad(t_s - kClock_s); }, -1, duration_s + 1, 200);
    const Eigen::Matrix<double, 3, 2> across = across_axis(axis);
    for (std::size_t k = 0; double(k + 1) * kSwing_s <= duration_s; ++k) {
      SweepPose sweep;
      sweep.sweep = k;
      sweep.begin_s = double(k) * kSwing_s;
      sweep.end_s = sweep.begin_s + kSwing_s;
      sweep.knots.clear();
      constexpr int kKnots = 9;
      for (int i = 0; i < kKnots; ++i) {
        const double t_s = sweep.begin_s + i * kSwing_s / (kKnots - 1);
        const Eigen::Vector3d turned_rad =
            Eigen::AngleAxisd(triangle_rad(t_s), axis.normalized()) * Eigen::Vector3d(across * turn_rad);
        sweep.knots.push_back({walking(t_s) * rotation_from_vector(turned_rad), {t_s, 0, 0}});
      }
      sweeps.push_back(sweep);
    }
  }

  std::optional<WalkTurn> turn() const { return turn_of_walk(recording, sweeps, kClock_s); }
};

class TurnOfWalk : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(TurnOfWalk, IsWhatThePathTakesUp) {
  for (const Eigen::Vector2d& turn_deg : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1.2, -0.7)}) {
    const auto seen = Walked(GetParam(), turn_deg * kRadPerDeg, 30).turn();
    ASSERT_TRUE(seen);
    EXPECT_LT((seen->turn_rad * kDegPerRad - turn_deg).norm(), 0.1);
    const Eigen::Vector2d apart_rad = seen->turn_rad - turn_deg * kRadPerDeg;
    EXPECT_LT(apart_rad.dot(seen->covariance.inverse() * apart_rad), 9);
    EXPECT_LT(std::sqrt(seen->covariance.diagonal().maxCoeff()) * kDegPerRad, 0.3);
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, TurnOfWalk,
                         testing::Values(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, -1),
                                         Eigen::Vector3d(0.3, 0.9, 0.2)));

// A rig that stands bends its map as its poses are: whatever sway they show is none of the mount.
TEST(TurnOfWalk, StandingCountsForNothing) {
  const Eigen::Vector2d turn_rad = Eigen::Vector2d(0.8, 0.5) * kRadPerDeg;
  Walked walked(Eigen::Vector3d::UnitX(), turn_rad, 30);
  const Walked swaying(Eigen::Vector3d::UnitX(), -2 * turn_rad, 30);
  constexpr std::size_t kStands = 20;  // sweeps
  for (std::size_t k = 0; k < kStands; ++k)
    for (std::size_t i = 0; i < walked.sweeps[k].knots.size(); ++i) {
      const double t_s = walked.sweeps[k].begin_s + double(i) * kSwing_s / 8;
      walked.sweeps[k].knots[i] = {walking(t_s).conjugate() * swaying.sweeps[k].knots[i].rotation, {}};
    }
  for (std::size_t k = kStands; k < walked.sweeps.size(); ++k) walked.sweeps[k].stretch = 1;
  const auto seen = walked.turn();
  ASSERT_TRUE(seen);
  EXPECT_LT((seen->turn_rad - turn_rad).norm() * kDegPerRad, 0.1);
}

// Across a gap, and across a stretch that was placed anew, the poses say nothing of the body's motion.
TEST(TurnOfWalk, SweepsThatDoNotFollowEachOtherAreNotCompared) {
  const Eigen::Vector2d turn_rad = Eigen::Vector2d(0.8, 0.5) * kRadPerDeg;
  Walked walked(Eigen::Vector3d::UnitX(), turn_rad, 30);
  const Eigen::Quaterniond elsewhere = rotation_from_vector({0.4, -1, 2});
  for (std::size_t k = 20; k < walked.sweeps.size(); ++k) {
    walked.sweeps[k].stretch = 1;
    for (Pose& knot : walked.sweeps[k].knots) knot.rotation = elsewhere * knot.rotation;
  }
  walked.sweeps[40].lost = true;
  for (Pose& knot : walked.sweeps[40].knots) knot.rotation = elsewhere;
  const auto seen = walked.turn();
  ASSERT_TRUE(seen);
  EXPECT_LT((seen->turn_rad - turn_rad).norm() * kDegPerRad, 0.1);
}

// A track that errs for 10 s at a time, or for 2 s: the turn is seen now larger, now smaller.
TEST(TurnOfWalk, SlowErrorsOfTheTrackWidenItsSigma) {
  const Eigen::Vector2d turn_rad = Eigen::Vector2d(0.8, 0.5) * kRadPerDeg;
  const Walked more(Eigen::Vector3d::UnitX(), turn_rad, 60), less(Eigen::Vector3d::UnitX(), -turn_rad, 60);
  const auto sigma_deg = [&](double at_a_time_s) {
    Walked erring = more;
    const auto sweeps = std::size_t(std::lround(at_a_time_s / kSwing_s));
    for (std::size_t k = 0; k < erring.sweeps.size(); ++k)
      if (k / sweeps % 2 == 1) erring.sweeps[k] = less.sweeps[k];
    return std::sqrt(erring.turn()->covariance.trace()) * kDegPerRad;
  };
  EXPECT_GT(sigma_deg(10), 1.4 * sigma_deg(2));
}

// Of walks in a house, which is followed well, and in a cemetery, where it is not.
TEST(TurnOfWalk, SolutionsThatScatterLeaveItOpen) {
  EXPECT_EQ(unconverged_rad({}), 0);
  EXPECT_DOUBLE_EQ(unconverged_rad(std::array{1.62, 0.29, 0.04}), 0.04);
  EXPECT_DOUBLE_EQ(unconverged_rad(std::array{0.29, 1.06, 0.05}), std::hypot(0.05, 1.06 - 0.29 / 2));
}

TEST(TurnOfWalk, IsAbsentOfLessThanTenSeconds) {
  EXPECT_FALSE(Walked(Eigen::Vector3d::UnitX(), {0, 0}, 9).turn());
  EXPECT_TRUE(Walked(Eigen::Vector3d::UnitX(), {0, 0}, 12).turn());
}

}  // namespace
}  // namespace sweepscope
