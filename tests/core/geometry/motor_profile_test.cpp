#include "core/geometry/motor_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

double deg_at(const MotorProfile& profile, double t_s) {
  return profile.angle_rad(t_s) * kDegPerRad;
}

TEST(MotorProfile, TurnsOneWayAtItsSpeedBothBeforeAndAfterAnUnknownStart) {
  MotorProfile profile;
  profile.turns_per_s = -0.5;
  EXPECT_NEAR(deg_at(profile, 3), -540, 1e-9);
  EXPECT_NEAR(deg_at(profile, -1), 180, 1e-9);
  EXPECT_DOUBLE_EQ(profile.sweep_s(), 1);
}

TEST(MotorProfile, RestsBeforeAKnownStartAndGainsItsSpeedInTheRamp) {
  MotorProfile profile;
  profile.turns_per_s = 1;
  profile.start_s = 0;
  profile.ramp_s = 2;
  EXPECT_EQ(profile.angle_rad(-1), 0);
  EXPECT_NEAR(deg_at(profile, 1), 90, 1e-9);   // half of 1 turn/s^2 / 2, after 1 s
  EXPECT_NEAR(deg_at(profile, 2), 360, 1e-9);  // half of the way at full speed
  EXPECT_NEAR(deg_at(profile, 3), 720, 1e-9);
}

TEST(MotorProfile, SwingsBetweenItsLimitsWithoutASpringAtTheReversal) {
  MotorProfile profile;
  profile.turns_per_s = 0.5;
  profile.between = MotorProfile::Limits{-30, 60};
  profile.ramp_s = 0.1;
  EXPECT_DOUBLE_EQ(profile.sweep_s(), 0.5);
  EXPECT_NEAR(deg_at(profile, 0), -30, 1e-9);
  EXPECT_NEAR(deg_at(profile, 0.25), 15, 1e-9);
  EXPECT_NEAR(deg_at(profile, 0.5), 60, 1e-9);
  EXPECT_NEAR(deg_at(profile, 1.25), 15, 1e-9);
  EXPECT_NEAR(deg_at(profile, -0.25), 15, 1e-9);  // an unknown start: on its way back before
  const double cruise_deg_s = 90 / (0.5 - 0.1);
  EXPECT_NEAR((deg_at(profile, 0.3) - deg_at(profile, 0.2)) / 0.1, cruise_deg_s, 1e-6);
  EXPECT_NEAR(deg_at(profile, 0.501), deg_at(profile, 0.499), 1e-9);
  EXPECT_LT(std::abs(deg_at(profile, 0.499) - 60), 0.01);
}

TEST(MotorProfile, RestsAfterEachStepAndIsWhereAnEvenMotionWouldBeAtItsEnds) {
  MotorProfile profile;
  profile.turns_per_s = 0.1;
  profile.steps_per_turn = 20;  // 18 deg in 0.5 s
  profile.dwell_s = 0.4;
  EXPECT_NEAR(deg_at(profile, 1.0), 36, 1e-9);
  EXPECT_NEAR(deg_at(profile, 1.39), 36, 1e-9);
  EXPECT_NEAR(deg_at(profile, 1.45), 45, 1e-9);
  EXPECT_NEAR(deg_at(profile, 1.5), 54, 1e-9);
  EXPECT_TRUE(profile.rests(1.39));
  EXPECT_FALSE(profile.rests(1.41));
  EXPECT_TRUE(profile.rests(-0.3));  // 0.2 s after the step before
}

}  // namespace
}  // namespace sweepscope
