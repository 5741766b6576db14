#include "core/loam/odometry.hpp"

#include <gtest/gtest.h>

#include "core/geometry/pose.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kDegree;

// What a rolled scanner at the origin sees of an empty room from `low` to `high`: lines 9 deg of roll apart,
// the first `shift` of that further on.
PlacedSweep empty_room(const Vector3d& low, const Vector3d& high, double shift) {
  PlacedSweep sweep;
  for (std::uint32_t line = 0; line < 20; ++line)
    for (double beam_deg = -85; beam_deg <= 85; beam_deg += 1.5) {
      const double roll_rad = (-90 + 9 * (line + shift)) * kDegree, beam_rad = beam_deg * kDegree;
      const Vector3d direction = Eigen::AngleAxisd(roll_rad, Vector3d::UnitX()) *
                                 Vector3d(std::cos(beam_rad), std::sin(beam_rad), 0);
      double range_m = 1e9;
      for (int i = 0; i < 3; ++i)
        range_m = std::min(range_m, (direction[i] < 0 ? low[i] : high[i]) / direction[i]);
      if (range_m < 30) sweep.planes.push_back({range_m * direction, 0.5, float(range_m), line, true});
    }
  return sweep;
}

const Vector3d kLow(-3, -2, -1.2), kHigh(4, 2.5, 1.6);

// The same points seen from a rig that has moved by `target_from_source`.
PlacedSweep seen_after(const Pose& target_from_source, PlacedSweep sweep) {
  for (PlacedFeature& feature : sweep.planes)
    feature.p_in_base_m = target_from_source.inverse() * feature.p_in_base_m;
  return sweep;
}

Registration register_after(const Pose& motion, const Vector3d& low, const Vector3d& high) {
  return register_rigidly(map_of(empty_room(low, high, 0)), seen_after(motion, empty_room(low, high, 0.5)),
                          OdometryOptions());
}

void expect_equal(const Pose& found, const Pose& expected, double tolerance_m, double tolerance_rad) {
  const Pose error = expected.inverse() * found;
  EXPECT_NEAR(error.translation_m.norm(), 0, tolerance_m);
  EXPECT_NEAR(vector_from_rotation(error.rotation).norm(), 0, tolerance_rad);
}

TEST(Odometry, FindsTheMotionBetweenTwoSweeps) {
  const Pose motion{rotation_from_vector({0.03, -0.01, 0.02}), {0.05, -0.03, 0.02}};
  const Registration found = register_after(motion, kLow, kHigh);
  ASSERT_TRUE(found.succeeded);
  EXPECT_EQ(found.free_directions, 0);
  expect_equal(found.target_from_source, motion, 1.5e-3, 1.5e-3);
}

// LOAM's public originals stop below 2 deg and 2 cm: exactly where the offset's valley has its ground.
// Patches that bend round the room's corners shift every answer alike, so answers are compared with the one
// for no motion.
TEST(Odometry, HasNoDeadZone) {
  const Pose at_rest = register_after(Pose{}, kLow, kHigh).target_from_source;
  for (const Pose& motion : {Pose{rotation_from_vector({0.0005, 0, 0}), Vector3d::Zero()},
                             Pose{Eigen::Quaterniond::Identity(), {0, 0.001, 0}}}) {
    const Pose found = register_after(motion, kLow, kHigh).target_from_source;
    expect_equal(found * at_rest.inverse(), motion, 5e-5, 5e-5);
  }
}

TEST(Odometry, ACorridorsFreeDirectionStaysAtNothingAndIsCounted) {
  const Pose motion{rotation_from_vector({0.01, 0, 0}), {0.1, 0.02, -0.01}};
  const Registration found = register_after(motion, {-1e6, -1.5, -1.2}, {1e6, 1.5, 1.3});
  ASSERT_TRUE(found.succeeded);
  EXPECT_EQ(found.free_directions, 1);
  EXPECT_NEAR(found.target_from_source.translation_m.x(), 0, 1e-3);
  EXPECT_NEAR(found.target_from_source.translation_m.y(), 0.02, 1e-3);
  EXPECT_NEAR(found.target_from_source.translation_m.z(), -0.01, 1e-3);
}

// The centre beam of every scan falls on one and the same point for every motor angle.
void add_axis_points(PlacedSweep& sweep, std::uint32_t count) {
  for (std::uint32_t line = 0; line < count; ++line) {
    sweep.planes.push_back({{4, 0, 0}, 0.5, 4, line % 20, true});
    sweep.edges.push_back({{4, 0, 0}, 0.5, 4, line % 20, true});
  }
}

TEST(Odometry, BeamsOnTheMotorsAxisDoNotHoldARotationBack) {
  const Pose motion{rotation_from_vector({0.02, 0, 0}), Vector3d::Zero()};
  PlacedSweep target = empty_room(kLow, kHigh, 0), source = seen_after(motion, empty_room(kLow, kHigh, 0.5));
  add_axis_points(target, 400);
  add_axis_points(source, 400);
  const Registration found = register_rigidly(map_of(target), source, OdometryOptions());
  ASSERT_TRUE(found.succeeded);
  EXPECT_NEAR(vector_from_rotation(found.target_from_source.rotation).x(), 0.02, 1e-3);
}

TEST(Odometry, BeamsOnTheMotorsAxisAloneAreNoRegistration) {
  PlacedSweep sweep;
  add_axis_points(sweep, 400);
  const Registration found = register_rigidly(map_of(sweep), sweep, OdometryOptions());
  EXPECT_FALSE(found.succeeded);
  EXPECT_TRUE(found.target_from_source.translation_m.allFinite());
}

TEST(Odometry, FewMatchesAreNoRegistration) {
  PlacedSweep source = empty_room(kLow, kHigh, 0.5);
  source.planes.resize(50);
  EXPECT_FALSE(register_rigidly(map_of(empty_room(kLow, kHigh, 0)), source, OdometryOptions()).succeeded);
}

}  // namespace
}  // namespace sweepscope
