#include "core/loam/smooth_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A rig that walks along x and sways about it, tracked in sweeps of half a second; each sweep turned by
// `jump_rad` against its neighbours.
std::vector<SweepPose> walk(std::size_t count, double jump_rad) {
  const auto pose = [&](double t_s, int direction) {
    return Pose{
        rotation_from_vector((0.01 * std::sin(2 * t_s) + direction * jump_rad / 2) * Vector3d::UnitX()),
        {t_s, 0.2 * t_s, 0.05 * std::sin(t_s)}};
  };
  std::vector<SweepPose> sweeps(count);
  for (std::size_t k = 0; k < count; ++k) {
    SweepPose& sweep = sweeps[k];
    sweep.sweep = k + 3;
    sweep.direction = k % 2 == 0 ? 1 : -1;
    sweep.begin_s = 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.begin = pose(sweep.begin_s, sweep.direction);
    sweep.end = pose(sweep.end_s, sweep.direction);
  }
  return sweeps;
}

double roll_rad(const Pose& pose) {
  return vector_from_rotation(pose.rotation).x();
}

TEST(SmoothPath, FollowsSweepsThatMeet) {
  const auto sweeps = walk(8, 0);
  const SmoothPath path(sweeps, 0.09);
  for (const SweepPose& sweep : sweeps) {
    const Pose found = path.at((sweep.begin_s + sweep.end_s) / 2), expected = sweep.middle();
    EXPECT_NEAR((found.translation_m - expected.translation_m).norm(), 0, 1e-4);
    EXPECT_NEAR(roll_rad(found), roll_rad(expected), 1e-4);
  }
}

TEST(SmoothPath, MeetsHalfWayWhereSweepsDoNot) {
  const auto sweeps = walk(8, 0.02);
  const SmoothPath path(sweeps, 0.09);
  for (std::size_t k = 1; k < sweeps.size(); ++k) {
    const double before = roll_rad(path.at(sweeps[k].begin_s - 1e-3)),
                 after = roll_rad(path.at(sweeps[k].begin_s + 1e-3));
    EXPECT_NEAR(before, after, 2e-3) << k;
    EXPECT_NEAR(before, (roll_rad(sweeps[k - 1].end) + roll_rad(sweeps[k].begin)) / 2, 2e-3) << k;
  }
}

TEST(SmoothPath, EndsAreInReach) {
  const auto sweeps = walk(3, 0);
  const SmoothPath path(sweeps, 0.09);
  EXPECT_GE(double(path.knots() - 1) * 0.09, 1.5);
  EXPECT_NEAR(path.at(-0.01).translation_m.x(), -0.01, 1e-6);
  EXPECT_EQ(path.place(-1).knot, 0u);
  EXPECT_EQ(path.place(-1).u, 0);
  EXPECT_EQ(path.place(100).knot, path.knots() - 2);
  EXPECT_EQ(path.place(100).u, 1);
}

TEST(SmoothPath, MovesAtKnotsAndLinearlyBetween) {
  const auto sweeps = walk(4, 0);
  SmoothPath path(sweeps, 0.1);
  const Pose knot = path.knot(5), between = path.at(0.55);
  std::vector<Vector6d> steps(path.knots(), Vector6d::Zero());
  steps[5] << 0.01, 0, 0, 0, 0.2, 0;
  path.move(steps);
  EXPECT_NEAR(roll_rad(path.knot(5)) - roll_rad(knot), 0.01, 1e-9);
  EXPECT_NEAR(path.knot(5).translation_m.y() - knot.translation_m.y(), 0.2, 1e-9);
  EXPECT_NEAR(path.at(0.55).translation_m.y() - between.translation_m.y(), 0.1, 1e-9);
  EXPECT_NEAR(path.knot(4).translation_m.y(), sweeps[0].at(0.8).translation_m.y(), 1e-4);
}

TEST(SmoothPath, AsASweepKeepsItsMiddle) {
  const auto sweeps = walk(6, 0.01);
  const SmoothPath path(sweeps, 0.09);
  const SweepPose sweep = path.as_sweep(sweeps[3]);
  EXPECT_EQ(sweep.sweep, sweeps[3].sweep);
  const Pose middle = path.at((sweep.begin_s + sweep.end_s) / 2);
  EXPECT_NEAR((sweep.middle().translation_m - middle.translation_m).norm(), 0, 1e-4);
  EXPECT_NEAR(roll_rad(sweep.middle()), roll_rad(middle), 1e-4);
  EXPECT_NEAR(roll_rad(sweep.begin), roll_rad(path.at(sweep.begin_s)), 1e-12);
}

}  // namespace
}  // namespace sweepscope
