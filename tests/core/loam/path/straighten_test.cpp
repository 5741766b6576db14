#include "core/loam/path/straighten.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/loam/path/path_equations.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A body that walks, sways and turns, but not in step with sweeps of half a second.
Pose bent_pose_at(double t_s) {
  const Vector3d turn_rad(0.05 * std::sin(2 * t_s), 0.04 * std::cos(4.1 * t_s), 0.5 * std::sin(0.3 * t_s));
  return {rotation_from_vector(turn_rad),
          {0.2 * std::sin(1.3 * t_s), std::sin(0.4 * t_s), 0.02 * std::cos(4.4 * t_s)}};
}

std::vector<SweepPose> walked(std::size_t count) {
  std::vector<SweepPose> sweeps(count);
  for (std::size_t k = 0; k < count; ++k) {
    SweepPose& sweep = sweeps[k];
    sweep.sweep = k;
    sweep.direction = k % 2 == 0 ? 1 : -1;
    sweep.begin_s = 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.stretch = 1;
    sweep.knots.clear();
    for (int i = 0; i <= 15; ++i) sweep.knots.push_back(bent_pose_at(sweep.begin_s + i / 30.0));
  }
  return sweeps;
}

// Each knot about its own place, in proportion to the motor's angle.
std::vector<SweepPose> bent(std::vector<SweepPose> sweeps, const Vector6d& deviation) {
  for (SweepPose& sweep : sweeps)
    for (std::size_t i = 0; i < sweep.knots.size(); ++i) {
      const double angle = sweep.direction * (2.0 * double(i) / double(sweep.knots.size() - 1) - 1);
      sweep.knots[i] = stepped(sweep.knots[i], angle * deviation, sweep.knots[i].translation_m);
    }
  return sweeps;
}

double most_apart(const std::vector<SweepPose>& a, const std::vector<SweepPose>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < a[k].knots.size(); ++i)
      most = std::max(most, difference(a[k].knots[i], b[k].knots[i]).cwiseAbs().maxCoeff());
  return most;
}

Vector6d some_bend() {
  Vector6d bend;
  bend << 0.02, -0.03, 0.01, 0.05, -0.03, 0.04;
  return bend;
}

TEST(Straightened, APathBentWithTheMotorIsStraight) {
  const std::vector<SweepPose> straight = walked(40), crooked = bent(straight, some_bend());
  ASSERT_GT(most_apart(crooked, straight), 0.04);
  EXPECT_LT(most_apart(straightened(crooked), straight), 0.004);
}

TEST(Straightened, AWalkThatDoesNotTurnBackWithTheMotorStays) {
  const std::vector<SweepPose> straight = walked(40);
  EXPECT_EQ(most_apart(straightened(straight), straight), 0);
}

// A recording may begin and end within a sweep.
TEST(Straightened, SweepsRecordedInPartAreStraightToo) {
  std::vector<SweepPose> straight = walked(40), crooked = bent(straight, some_bend());
  for (std::vector<SweepPose>* sweeps : {&straight, &crooked}) {
    SweepPose &first = sweeps->front(), &last = sweeps->back();
    first.begin_s += 0.2;
    first.knots.erase(first.knots.begin(), first.knots.begin() + 6);
    last.end_s -= 0.3;
    last.knots.resize(7);
  }
  EXPECT_LT(most_apart(straightened(crooked), straight), 0.004);
}

TEST(Straightened, EveryStretchIsStraightenedByItself) {
  const std::vector<SweepPose> straight = walked(60);
  std::vector<SweepPose> crooked = bent(straight, some_bend());
  const std::vector<SweepPose> otherwise = bent(straight, -some_bend());
  for (std::size_t k = 30; k < crooked.size(); ++k) {
    crooked[k] = otherwise[k];
    crooked[k].stretch = 2;
  }
  EXPECT_LT(most_apart(straightened(crooked), straight), 0.006);
}

TEST(Straightened, LostSweepsDoNotCount) {
  const std::vector<SweepPose> straight = walked(40);
  std::vector<SweepPose> crooked = bent(straight, some_bend());
  for (const std::size_t lost : {11u, 12u, 25u}) {
    crooked[lost].lost = true;
    for (Pose& knot : crooked[lost].knots) knot.translation_m += Vector3d(1, 2, 3);
  }
  const std::vector<SweepPose> found = straightened(crooked);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!crooked[k].lost) {
      EXPECT_LT(most_apart({found[k]}, {straight[k]}), 0.006) << k;
    }
  }
}

TEST(Straightened, SweepsOfOneDirectionStay) {
  std::vector<SweepPose> crooked = bent(walked(40), some_bend());
  for (SweepPose& sweep : crooked) sweep.direction = 1;
  EXPECT_EQ(most_apart(straightened(crooked), crooked), 0);
}

TEST(Straightened, SweepsThatWereNotTrackedStay) {
  std::vector<SweepPose> crooked = bent(walked(40), some_bend());
  for (SweepPose& sweep : crooked) sweep.stretch = 0;
  EXPECT_EQ(most_apart(straightened(crooked), crooked), 0);
  EXPECT_TRUE(straightened({}).empty());
}

}  // namespace
}  // namespace sweepscope
