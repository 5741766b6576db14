#include "core/loam/sweep_features.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/loam/mapping.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// The motor turns upwards at 2 rad/s from -1 rad at t_motor = 0, and back again from 1 s on. One scan of one
// beam every 50 ms, each with one plane point 3 m to the left.
class PlaceSweeps : public testing::Test {
 protected:
  PlaceSweeps() {
    recording_.motor = test::track_of([](double t_s) { return 1 - 2 * std::abs(t_s - 1); }, 0, 2);
    auto features = std::make_shared<FeatureSet>();
    for (std::uint32_t i = 0; i < 40; ++i) {
      recording_.scans.push_back({0.05 * i, 1e-5, 0, 0, 0, 1});
      features->planes.scan_begin.push_back(i);
      features->edges.scan_begin.push_back(0);
      features->planes.features.push_back({{0, 3, 0}, 3, 0.05 * i, i, 0, true});
    }
    features->planes.scan_begin.push_back(40);
    features->edges.scan_begin.push_back(0);
    problem_ = {&recording_, features, find_sweeps(recording_.motor), std::vector<char>(40, 1)};
  }
  Recording recording_;
  OffsetProblem problem_;
};

// By hand: a beam stamped 0.5 s is placed with the angle that the motor has at 0.5 s + offset on its own
// clock.
TEST_F(PlaceSweeps, ABeamStampedTIsPlacedWithTheMotorsAngleAtTPlusOffset) {
  for (const double offset_s : {-0.02, 0.0, 0.1}) {
    const std::vector<PlacedSweep> sweeps = place_sweeps(problem_, offset_s);
    const auto& placed = sweeps.front().planes;
    const auto beam = std::find_if(placed.begin(), placed.end(), [](const auto& f) { return f.line == 10; });
    ASSERT_NE(beam, placed.end());
    const double angle_rad = -1 + 2 * (0.5 + offset_s);
    EXPECT_NEAR((beam->p_in_base_m - 3 * Vector3d(0, std::cos(angle_rad), std::sin(angle_rad))).norm(), 0,
                1e-9);
  }
}

TEST_F(PlaceSweeps, SweepsBeginAndEndOnTheLasersClock) {
  const std::vector<PlacedSweep> placed = place_sweeps(problem_, 0.1);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].direction, 1);
  EXPECT_EQ(placed[1].direction, -1);
  EXPECT_NEAR(placed[0].end_s, 0.9, 1e-3);
  for (const PlacedSweep& sweep : placed)
    for (const PlacedFeature& feature : sweep.planes)
      EXPECT_NEAR(sweep.begin_s + feature.u * (sweep.end_s - sweep.begin_s), 0.05 * feature.line, 1e-9);
}

TEST_F(PlaceSweeps, NothingIsPlacedNearAReversal) {
  for (const PlacedSweep& sweep : place_sweeps(problem_, 0.0))
    for (const PlacedFeature& feature : sweep.planes) EXPECT_GT(std::abs(0.05 * feature.line - 1), 0.02);
}

TEST_F(PlaceSweeps, ScansThatAreNotUsedAreLeftOut) {
  std::fill(problem_.scan_used.begin(), problem_.scan_used.begin() + 20, 0);
  const std::vector<PlacedSweep> placed = place_sweeps(problem_, 0.0);
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_EQ(placed[0].direction, -1);
  EXPECT_LE(placed[0].scans, 20u);
}

TEST(SweepMotion, IsTheInterpolatedPose) {
  const Pose begin{rotation_from_vector({0.3, -0.8, 0.2}), {1, 2, 3}},
      end{rotation_from_vector({0.5, -0.6, 0.9}), {2, 2, 1}};
  const SweepMotion motion(std::array{begin, end});
  const Vector3d p_m(4, -1, 0.5);
  for (const double u : {-0.1, 0.0, 0.4, 1.0})
    EXPECT_NEAR((motion(p_m, u) - interpolate(begin, end, u) * p_m).norm(), 0, 1e-12) << u;
  EXPECT_NEAR((SweepMotion(std::array{begin, begin})(p_m, 0.7) - begin * p_m).norm(), 0, 1e-12);
}

TEST(SweepMotion, TurnsAtItsKnots) {
  SweepPose pose;
  pose.knots = {
      {}, {rotation_from_vector({0.1, 0, 0}), {1, 0, 0}}, {rotation_from_vector({0, 0.2, 0}), {1, 3, 0}}};
  const Vector3d p_m(0, 5, 0);
  for (const double u : {0.0, 0.2, 0.5, 0.8, 1.0, 1.1})
    EXPECT_NEAR((pose.motion()(p_m, u) - pose.at(u) * p_m).norm(), 0, 1e-12) << u;
  EXPECT_NEAR((pose.at(0.5) * p_m - pose.knots[1] * p_m).norm(), 0, 1e-12);
  EXPECT_NEAR(pose.at(0.75).translation_m.y(), 1.5, 1e-12);
}

TEST(SweepMotion, OfASweepsFirstPartEndsWhereThatDoes) {
  const std::array knots{Pose{}, Pose{rotation_from_vector({0, 0, 0.3}), {1, 0, 0}}};
  const SweepMotion first_half(knots, 0.5);
  const Vector3d p_m(1, 2, 3);
  EXPECT_NEAR((first_half(p_m, 0.5) - knots[1] * p_m).norm(), 0, 1e-12);
}

TEST_F(PlaceSweeps, AnyOfThemCanBePlacedByItself) {
  SweepPlacer placer(problem_, 0.0);
  const std::vector<PlacedSweep> all = place_sweeps(problem_, 0.0);
  ASSERT_EQ(placer.count(), all.size());
  PlacedSweep last;
  placer.place(all.size() - 1, last);
  EXPECT_EQ(last.sweep, all.back().sweep);
  EXPECT_EQ(last.planes.size(), all.back().planes.size());
}

TEST_F(PlaceSweeps, ASweepKnowsHowFarTheMotorTurned) {
  for (const PlacedSweep& sweep : place_sweeps(problem_, 0.0)) {
    const Sweep& motor = problem_.motor.sweeps[sweep.sweep];
    EXPECT_GT(sweep.turned_rad.x() * sweep.direction, 0.8 * problem_.motor.range_rad);
    EXPECT_LT(sweep.turned_rad.x() * motor.direction, 1.2 * problem_.motor.range_rad);
  }
}

}  // namespace
}  // namespace sweepscope
