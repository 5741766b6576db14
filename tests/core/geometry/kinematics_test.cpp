#include "core/geometry/kinematics.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using test::kDegree;

class Mounts : public testing::TestWithParam<Vector3d> {
 protected:
  Mounts() {
    mount_.axis = GetParam();
    mount_.laser_in_motor_xyz_m = {0.08, -0.03, 0.11};
    mount_.laser_in_motor_rpy_deg = {10, -25, 40};
  }
  Rig::Mount mount_;
};

// Written out with Eigen's own rotations, as the rig file's comment defines it: R = Rz(yaw) Ry(pitch)
// Rx(roll).
TEST_P(Mounts, ABeamIsTurnedByTheMotorAfterTheLasersPose) {
  const Kinematics kinematics(mount_);
  const auto motor_from_laser = AngleAxisd(40 * kDegree, Vector3d::UnitZ()) *
                                AngleAxisd(-25 * kDegree, Vector3d::UnitY()) *
                                AngleAxisd(10 * kDegree, Vector3d::UnitX());
  for (const double motor_angle_rad : {-2.0, -0.3, 0.0, 1.2, 3.1}) {
    const Vector3d p_in_laser_m(4 * std::cos(0.6), 4 * std::sin(0.6), 0);
    const Vector3d expected = AngleAxisd(motor_angle_rad, GetParam().normalized()) *
                              (motor_from_laser * p_in_laser_m + Vector3d(0.08, -0.03, 0.11));
    const Vector3d found = kinematics.base_from_motor(kinematics.point_in_motor(4, 0.6), motor_angle_rad);
    EXPECT_NEAR((found - expected).norm(), 0, 1e-14) << motor_angle_rad;
  }
}

TEST_P(Mounts, TheLeverIsTheRadiusOfThePointsCircle) {
  const Kinematics kinematics(mount_);
  const Vector3d p_in_motor_m = kinematics.point_in_motor(4, 0.6);
  const Vector3d opposite = kinematics.base_from_motor(p_in_motor_m, test::kPi);
  EXPECT_NEAR(kinematics.distance_to_axis_m(p_in_motor_m), (opposite - p_in_motor_m).norm() / 2, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(RollTiltYawAndSkew, Mounts,
                         testing::Values(Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(),
                                         Vector3d(1, 2, -2)));

TEST(Kinematics, AnAxisOfAnyLengthIsADirection) {
  Rig::Mount mount;
  mount.axis = {0, 0, 5};
  EXPECT_NEAR(Kinematics(mount).axis().norm(), 1, 1e-15);
}

class MotorReading : public testing::Test {
 protected:
  MotorTrack track_ = test::track_of([](double t_s) { return std::sin(7 * t_s) + 0.1 * t_s; }, 1.0, 3.0, 97);
};

TEST_F(MotorReading, EqualsTheTracksAngleWhicheverWayTheInstantsGo) {
  MotorReader reader(track_);
  for (double t_s = 1.0; t_s < 3.0; t_s += 0.0037)
    EXPECT_DOUBLE_EQ(reader.angle_at(t_s), track_.angle_at(t_s));
  for (double t_s = 2.9; t_s > 1.0; t_s -= 0.0713)
    EXPECT_DOUBLE_EQ(reader.angle_at(t_s), track_.angle_at(t_s));
  for (const double t_s : {2.7, 1.1, 2.2, track_.time_s[5], track_.time_s[4], 1.9})
    EXPECT_DOUBLE_EQ(reader.angle_at(t_s), track_.angle_at(t_s));
}

TEST_F(MotorReading, OutsideTheTrackIsTheNearestEndsAngle) {
  MotorReader reader(track_);
  EXPECT_DOUBLE_EQ(reader.angle_at(-5), track_.angle_rad.front());
  EXPECT_DOUBLE_EQ(reader.angle_at(99), track_.angle_rad.back());
}

TEST_F(MotorReading, ATrackOfOneSampleOrNoneHasOneAngle) {
  EXPECT_EQ(MotorReader(MotorTrack{}).angle_at(1), 0);
  const MotorTrack one{{2.0}, {0.4}};
  EXPECT_EQ(MotorReader(one).angle_at(7), 0.4);
}

}  // namespace
}  // namespace sweepscope
