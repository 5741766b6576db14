#include "core/geometry/gear.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

MotorTrack to_and_fro() {
  MotorTrack track;
  for (const double angle_rad : {0.0, 0.1, 0.2, 0.3, 0.2, 0.1, 0.0, -0.1, 0.0, 0.1}) {
    track.angle_rad.push_back(angle_rad);
    track.time_s.push_back(0.01 * double(track.time_s.size()));
  }
  return track;
}

TEST(Gear, PlayLeavesTheLaserBehindByHalfOfItAndAtRestWhileItIsUsedUp) {
  const MotorTrack laser = laser_angles(to_and_fro(), {0.15, Eigen::Vector2d::Zero()});
  const double expected_rad[] = {0.0, 0.025, 0.125, 0.225, 0.225, 0.175, 0.075, -0.025, -0.025, 0.025};
  for (std::size_t i = 0; i < std::size(expected_rad); ++i)
    EXPECT_NEAR(laser.angle_rad[i], expected_rad[i], 1e-12) << i;
}

TEST(Gear, AnEccentricEncoderIsTakenOut) {
  MotorTrack shown;
  std::vector<double> shaft_rad;
  constexpr double kAmplitude_rad = 0.003, kPhase_rad = 0.7;
  for (int i = -15; i <= 15; ++i) {
    shaft_rad.push_back(0.1 * i);
    shown.time_s.push_back(0.01 * i);
    shown.angle_rad.push_back(shaft_rad.back() + kAmplitude_rad * std::sin(shaft_rad.back() + kPhase_rad));
  }
  const Gear gear{0, {kAmplitude_rad * std::cos(kPhase_rad), kAmplitude_rad * std::sin(kPhase_rad)}};
  const MotorTrack laser = laser_angles(shown, gear);
  for (std::size_t i = 0; i < shaft_rad.size(); ++i)
    EXPECT_NEAR(laser.angle_rad[i], shaft_rad[i], kAmplitude_rad * kAmplitude_rad);
}

TEST(Gear, APerfectOneChangesNothing) {
  EXPECT_TRUE(Gear().perfect());
  EXPECT_EQ(laser_angles(to_and_fro(), {}).angle_rad, to_and_fro().angle_rad);
}

}  // namespace
}  // namespace sweepscope
