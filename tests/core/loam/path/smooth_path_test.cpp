#include "core/loam/path/smooth_path.hpp"

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
    sweep.knots.clear();
    for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0})
      sweep.knots.push_back(pose(sweep.begin_s + 0.5 * u, sweep.direction));
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
    EXPECT_NEAR(before, (roll_rad(sweeps[k - 1].end()) + roll_rad(sweeps[k].begin())) / 2, 3e-3) << k;
  }
}

TEST(SmoothPath, EndsAreInReach) {
  const auto sweeps = walk(3, 0);
  const SmoothPath path(sweeps, 0.09);
  EXPECT_GE(double(path.knots() - 3) * 0.09, 1.5);
  EXPECT_NEAR(path.at(-0.01).translation_m.x(), -0.01, 1e-3);
  EXPECT_EQ(path.place(-1).first_knot, 0u);
  EXPECT_EQ(path.place(-1).weights, path.place(0).weights);
  EXPECT_EQ(path.place(100).first_knot, path.knots() - 4);
  EXPECT_EQ(path.place(100).weights[0], 0);
}

TEST(SmoothPath, MovesAsItsPlacesSay) {
  SmoothPath path(walk(4, 0), 0.1);
  const auto times_s = {0.03, 0.41, 0.55, 0.6, 1.2};
  std::vector<Pose> before;
  for (const double time_s : times_s) before.push_back(path.at(time_s));
  std::vector<Vector6d> steps(path.knots(), Vector6d::Zero());
  steps[6] << 1e-3, 0, 0, 0, 0.2, 0;
  path.move(steps);
  auto was = before.begin();
  for (const double time_s : times_s) {
    const SmoothPath::Place place = path.place(time_s);
    double weight = 0;
    for (std::size_t i = 0; i < 4; ++i)
      if (place.first_knot + i == 6) weight = place.weights[i];
    // Between the samples of the spline the pose goes linearly.
    EXPECT_NEAR(path.at(time_s).translation_m.y() - was->translation_m.y(), 0.2 * weight, 2e-3) << time_s;
    EXPECT_NEAR(roll_rad(path.at(time_s)) - roll_rad(*was), 1e-3 * weight, 1e-5) << time_s;
    ++was;
  }
}

TEST(SmoothPath, WeightsAddUpToOne) {
  const SmoothPath path(walk(4, 0), 0.1);
  for (double time_s = 0; time_s < 2; time_s += 0.013) {
    const auto weights = path.place(time_s).weights;
    EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1, 1e-12);
  }
}

TEST(SmoothPath, HasNoKinks) {
  const SmoothPath path(walk(6, 0.02), 0.1);
  const double step_s = 0.0125;
  for (double time_s = 0.1; time_s < 2.5; time_s += step_s) {
    const double before = roll_rad(path.at(time_s)) - roll_rad(path.at(time_s - step_s)),
                 after = roll_rad(path.at(time_s + step_s)) - roll_rad(path.at(time_s));
    EXPECT_LT(std::abs(after - before), 1e-3) << time_s;  // of a jump of 20 mrad
  }
}

TEST(SmoothPath, AsASweepKeepsItsMiddle) {
  const auto sweeps = walk(6, 0.01);
  const SmoothPath path(sweeps, 0.09);
  const SweepPose sweep = path.as_sweep(sweeps[3]);
  EXPECT_EQ(sweep.sweep, sweeps[3].sweep);
  const Pose middle = path.at((sweep.begin_s + sweep.end_s) / 2);
  EXPECT_NEAR((sweep.middle().translation_m - middle.translation_m).norm(), 0, 1e-4);
  EXPECT_NEAR(roll_rad(sweep.middle()), roll_rad(middle), 1e-4);
  EXPECT_NEAR(roll_rad(sweep.begin()), roll_rad(path.at(sweep.begin_s)), 1e-12);
}

}  // namespace
}  // namespace sweepscope
