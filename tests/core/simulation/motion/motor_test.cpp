#include "core/simulation/motion/motor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

constexpr double kSweep_s = 0.513;

class BackAndForth : public testing::TestWithParam<MotorKind> {};

TEST_P(BackAndForth, ReversesAtNinetyDegreesEverySweep) {
  const Motor motor(GetParam(), kSweep_s, 0);
  for (int sweep = -3; sweep < 4; ++sweep) {
    const double sign = sweep % 2 == 0 ? 1 : -1;
    EXPECT_NEAR(degrees(motor.angle_rad(sweep * kSweep_s)), 0, 1e-9);
    EXPECT_NEAR(degrees(motor.angle_rad((sweep + 0.5) * kSweep_s)), sign * 90, 1e-9);
    EXPECT_GT(sign * motor.angle_rad((sweep + 0.1) * kSweep_s), 0);
  }
}

TEST_P(BackAndForth, MirrorsItselfOneSweepLater) {
  const Motor motor(GetParam(), kSweep_s, 0.2);
  for (double t_s = 0; t_s < 2; t_s += 0.031)
    EXPECT_NEAR(motor.angle_rad(t_s + kSweep_s), -motor.angle_rad(t_s), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Motors, BackAndForth,
                         testing::Values(MotorKind::kTriangle, MotorKind::kTrapezoid, MotorKind::kSine));

TEST(Motor, TrapezoidTurnsSteadilyAndReversesWithFiniteAcceleration) {
  const Motor motor(MotorKind::kTrapezoid, 0.5, 0);
  constexpr double kStep_s = 1e-4;
  const auto speed = [&](double t_s) {
    return (motor.angle_rad(t_s + kStep_s) - motor.angle_rad(t_s - kStep_s)) / (2 * kStep_s);
  };
  EXPECT_NEAR(speed(0.0), speed(0.2), 1e-6);
  EXPECT_NEAR(speed(0.25), 0, 1e-6);
  for (double t_s = 0; t_s < 1; t_s += kStep_s)
    EXPECT_LT(std::abs(speed(t_s + kStep_s) - speed(t_s)) / kStep_s, 250) << t_s;
}

TEST(Motor, PhaseIsTheTimeSinceThePassageUpwards) {
  const Motor motor(MotorKind::kTriangle, 0.5, 0.1);
  EXPECT_NEAR(degrees(motor.angle_rad(-0.1)), 0, 1e-9);
  EXPECT_NEAR(degrees(motor.angle_rad(0)), 36, 1e-9);
}

TEST(Motor, StepsBeginWithARestAtAnEndOfTheSwing) {
  // Half a turn in 1 s, in ten steps, each with a rest of 60 ms and a motion of 40 ms.
  const Motor motor(MotorKind::kTriangle, 1, 0, {}, {}, kPi / 2, {}, {0.1, 0.06});
  for (int step = 0; step < 10; ++step) {
    const double begin_s = -0.5 + 0.1 * step, at_deg = -90 + 18.0 * step;
    EXPECT_NEAR(degrees(motor.angle_rad(begin_s + 0.001)), at_deg, 1e-9);
    EXPECT_NEAR(degrees(motor.angle_rad(begin_s + 0.059)), at_deg, 1e-9);
    EXPECT_NEAR(degrees(motor.angle_rad(begin_s + 0.08)), at_deg + 9, 1e-9);
  }
  const Motor one_way(MotorKind::kOneWay, 1, 0, {}, {}, kPi / 2, {}, {0.1, 0.06});
  EXPECT_NEAR(degrees(one_way.angle_rad(0.05)), 0, 1e-9);
  EXPECT_NEAR(degrees(one_way.angle_rad(0.18)), 27, 1e-9);
}

TEST(Motor, OneWayTurnsOnAndStuckStays) {
  const Motor one_way(MotorKind::kOneWay, 0.5, 0), stuck(MotorKind::kStuck, 0.5, 0.1);
  EXPECT_NEAR(degrees(one_way.angle_rad(2.0)), 720, 1e-9);
  EXPECT_EQ(stuck.angle_rad(0.0), stuck.angle_rad(1.234));
}

TEST(Motor, OneWayKeepsEachSpeedForItsPart) {
  const Motor motor(MotorKind::kOneWay, 0.5, 0, {}, {{radians(360), radians(180)}, false, 10});
  const auto speed_dps = [&](double t_s) {
    return degrees(motor.angle_rad(t_s + 0.01) - motor.angle_rad(t_s - 0.01)) / 0.02;
  };
  for (const double t_s : {-0.2, 0.0, 2.0, 4.8}) EXPECT_NEAR(speed_dps(t_s), 360, 1e-6) << t_s;
  EXPECT_NEAR(speed_dps(5), 270, 1e-6);  // while it changes
  for (const double t_s : {5.2, 8.0, 10.0, 10.2}) EXPECT_NEAR(speed_dps(t_s), 180, 1e-6) << t_s;
  EXPECT_NEAR(degrees(motor.angle_rad(10) - motor.angle_rad(0)), 5 * 360 + 5 * 180, 1e-6);
}

TEST(Motor, OneWayWithARampTurnsEvenlyFasterOrSlower) {
  const Motor motor(MotorKind::kOneWay, 0.5, 0, {}, {{radians(100), radians(300), radians(200)}, true, 8});
  const auto speed_dps = [&](double t_s) {
    return degrees(motor.angle_rad(t_s + 0.01) - motor.angle_rad(t_s - 0.01)) / 0.02;
  };
  EXPECT_NEAR(speed_dps(1), 150, 1e-6);
  EXPECT_NEAR(speed_dps(2), 200, 1e-6);
  EXPECT_NEAR(speed_dps(6), 250, 1e-6);
  EXPECT_NEAR(speed_dps(-0.1), 100, 1e-6);
  EXPECT_NEAR(speed_dps(8.1), 200, 1e-6);
}

TEST(Motor, BacklashLeavesTheLaserBehindInEitherDirection) {
  const Motor motor(MotorKind::kTriangle, 0.5, 0);
  const double play_rad = radians(2);
  EXPECT_NEAR(degrees(motor.laser_angle_rad(0.0, play_rad)), -1, 1e-9);
  EXPECT_NEAR(degrees(motor.laser_angle_rad(0.5, play_rad)), 1, 1e-9);
  // Just after the reversal the play is not used up yet.
  EXPECT_NEAR(degrees(motor.laser_angle_rad(0.251, play_rad)), 89, 1e-9);
}

TEST(Motor, NamesAreReadBack) {
  for (const std::string_view name : motor_names()) EXPECT_EQ(name_of(motor_kind(name).value()), name);
  EXPECT_FALSE(motor_kind("square"));
}

}  // namespace
}  // namespace sweepscope::simulation
