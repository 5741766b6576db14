#include "core/rig_solve/rig_unknowns.hpp"

#include <gtest/gtest.h>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

Mount tilted_mount() {
  Mount mount;
  mount.axis = Eigen::Vector3d(0.2, 0.9, -0.1).normalized();
  mount.laser_in_motor_xyz_m = {0.03, -0.02, 0.05};
  mount.laser_in_motor_rpy_deg = {4, -7, 11};
  return mount;
}

RigUnknowns some_unknowns() {
  RigUnknowns rig;
  rig.offset_s = 0.02;
  rig.turn_rad = {0.13, -0.08};
  rig.shift_m = {0.04, 0.07};
  rig.play_rad = 0.006;
  rig.encoder_rad = {0.004, -0.009};
  return rig;
}

// A motor whose angle and speed are known at every instant.
RigGeometry::Instant motor_at(double t_s, int direction) {
  return {direction * (0.7 * t_s + 0.4 * t_s * t_s), direction * (0.7 + 0.8 * t_s), direction};
}

Eigen::Vector3d placed_at(const RigUnknowns& rig, double laser_s, int direction) {
  const Eigen::Vector3d p_in_motor_m(2.1, -3.3, 0.4);
  return RigGeometry(tilted_mount(), rig)
      .place(p_in_motor_m, motor_at(laser_s + rig.offset_s, direction))
      .p_in_base_m;
}

TEST(RigUnknowns, TheJacobianIsThatOfFiniteDifferences) {
  constexpr double kStep = 1e-6, kLaser_s = 0.6;
  for (const int direction : {1, -1}) {
    const RigVector x = some_unknowns().vector();
    const auto at = RigGeometry(tilted_mount(), some_unknowns())
                        .place({2.1, -3.3, 0.4}, motor_at(kLaser_s + x[kOffset], direction));
    for (int i = 0; i < kRigUnknowns; ++i) {
      const RigVector step = kStep * RigVector::Unit(i);
      const Eigen::Vector3d numeric = (placed_at(RigUnknowns::from(x + step), kLaser_s, direction) -
                                       placed_at(RigUnknowns::from(x - step), kLaser_s, direction)) /
                                      (2 * kStep);
      EXPECT_LT((at.jacobian.col(i) - numeric).norm(), 1e-7 * std::max(1.0, numeric.norm()))
          << "unknown " << i << ", direction " << direction;
    }
  }
}

TEST(RigUnknowns, APointIsWhereTheChangedMountAndGearPlaceIt) {
  const RigUnknowns rig = some_unknowns();
  const Eigen::Vector3d p_in_laser_m(3.0, 1.0, 0.0);
  const Mount before = tilted_mount(), after = changed(before, rig);
  const RigGeometry::Instant at = motor_at(0.5, -1);
  const Eigen::Vector3d p_in_motor_m =
      rotation_from_rpy(before.laser_in_motor_rpy_deg) * p_in_laser_m + before.laser_in_motor_xyz_m;
  const double laser_angle_rad = at.angle_rad - rig.encoder_rad[0] * std::sin(at.angle_rad) -
                                 rig.encoder_rad[1] * std::cos(at.angle_rad) + rig.play_rad / 2;
  const Eigen::Vector3d expected_m = Kinematics(after).base_from_motor(
      rotation_from_rpy(after.laser_in_motor_rpy_deg) * p_in_laser_m + after.laser_in_motor_xyz_m,
      laser_angle_rad);
  EXPECT_LT((RigGeometry(before, rig).place(p_in_motor_m, at).p_in_base_m - expected_m).norm(), 1e-12);
}

TEST(RigUnknowns, NeitherTurnNorShiftGoesAlongTheAxis) {
  const Mount before = tilted_mount(), after = changed(before, some_unknowns());
  EXPECT_NEAR((after.laser_in_motor_xyz_m - before.laser_in_motor_xyz_m).dot(before.axis), 0, 1e-12);
  const Eigen::Quaterniond turn = rotation_from_rpy(after.laser_in_motor_rpy_deg) *
                                  rotation_from_rpy(before.laser_in_motor_rpy_deg).conjugate();
  EXPECT_NEAR(vector_from_rotation(turn).dot(before.axis), 0, 1e-12);
  EXPECT_NEAR(vector_from_rotation(turn).norm(), some_unknowns().turn_rad.norm(), 1e-12);
}

TEST(RigUnknowns, WhatCannotBeObservedStaysWhereTheAxisIsACoordinateAxis) {
  for (int i = 0; i < 3; ++i)
    for (const double sign : {1.0, -1.0}) {
      Mount before = tilted_mount();
      before.axis = sign * Eigen::Vector3d::Unit(i);
      const Mount after = changed(before, some_unknowns());
      EXPECT_NEAR(after.laser_in_motor_rpy_deg[i], before.laser_in_motor_rpy_deg[i], 1e-9) << i;
      EXPECT_GT((after.laser_in_motor_rpy_deg - before.laser_in_motor_rpy_deg).norm(), 5);
    }
}

TEST(RigUnknowns, NothingChangedLeavesTheMountToTheBit) {
  const Mount before = tilted_mount(), after = changed(before, RigUnknowns());
  EXPECT_EQ(after.laser_in_motor_rpy_deg, before.laser_in_motor_rpy_deg);
  EXPECT_EQ(after.laser_in_motor_xyz_m, before.laser_in_motor_xyz_m);
}

}  // namespace
}  // namespace sweepscope
