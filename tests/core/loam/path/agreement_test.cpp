#include "core/loam/path/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A walk at 1 m/s. Between two times it is creeping, in the eyes of a track that errs.
Pose strolled_to(double t_s, double creeps_from_s, double creeps_to_s) {
  constexpr double kCreep_mps = 0.1;
  const double crept_s = std::clamp(t_s, creeps_from_s, creeps_to_s) - creeps_from_s;
  return {rotation_from_vector({0.03 * std::sin(2 * t_s), 0, 0.2 * t_s}),
          Vector3d(t_s - (1 - kCreep_mps) * crept_s, 0.02 * std::cos(6 * t_s), 0)};
}

std::vector<SweepPose> stroll(double creeps_from_s = 0, double creeps_to_s = 0) {
  std::vector<SweepPose> sweeps(40);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    SweepPose& sweep = sweeps[k];
    sweep.sweep = k;
    sweep.direction = k % 2 == 0 ? 1 : -1;
    sweep.begin_s = 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.knots.clear();
    for (int i = 0; i <= 10; ++i)
      sweep.knots.push_back(strolled_to(sweep.begin_s + i / 20.0, creeps_from_s, creeps_to_s));
  }
  return sweeps;
}

std::size_t agreed(const std::vector<SweepPose>& a, const std::vector<SweepPose>& b) {
  return std::size_t(std::ranges::count(agreeing(a, b), 1));
}

TEST(Agreeing, TracksOnMapsOfTheirOwnAgreeWhereverTheirMapsLie) {
  std::vector<SweepPose> moved = stroll();
  const Pose there{rotation_from_vector({0, 0, 2}), Vector3d(5, -3, 1)};
  for (SweepPose& sweep : moved)
    for (Pose& knot : sweep.knots) knot = there * knot;
  EXPECT_EQ(agreed(stroll(), moved), 40u);
}

TEST(Agreeing, WhereOneTrackCreepsTheyDisagree) {
  const std::vector<char> found = agreeing(stroll(), stroll(8, 12));
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k] == 0, k >= 16 && k < 24) << k;
}

TEST(Agreeing, ASweepThatEitherLostIsNotConfirmed) {
  std::vector<SweepPose> lost = stroll();
  lost[20].lost = true;
  EXPECT_EQ(agreed(stroll(), lost), 39u);
  EXPECT_EQ(agreed(lost, stroll()), 39u);
}

TEST(Agreeing, AMapThatIsBentWithTheMotorAgreesWithAStraightOne) {
  std::vector<SweepPose> bent = stroll();
  Vector6d bend;
  bend << 0.03, 0, 0, 0, 0.05, 0;
  for (SweepPose& sweep : bent)
    for (std::size_t i = 0; i < sweep.knots.size(); ++i) {
      const double angle = sweep.direction * (2.0 * double(i) / double(sweep.knots.size() - 1) - 1);
      const Pose deviation = stepped(Pose{}, angle * bend, Vector3d::Zero());
      sweep.knots[i] = sweep.knots[i] * deviation;
    }
  EXPECT_EQ(agreed(stroll(), bent), 40u);
}

TEST(Agreeing, OfLessThanTwoSecondsNothingIsConfirmed) {
  std::vector<SweepPose> few = stroll();
  few.resize(3);
  EXPECT_EQ(agreed(few, few), 0u);
}

}  // namespace
}  // namespace sweepscope
