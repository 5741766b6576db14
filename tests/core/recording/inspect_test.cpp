#include "core/recording/inspect.hpp"

#include <gtest/gtest.h>

#include "tests/core/small_recording.hpp"

namespace sweepscope {
namespace {

using test::recording_of, test::track, test::triangle_rad;

TEST(Inspect, MeasuresTheMotor) {
  const MotorSummary motor = inspect(recording_of(track(5.2, 0.01, triangle_rad))).motor;
  EXPECT_NEAR(motor.min_deg, -57.3, 0.1);
  EXPECT_NEAR(motor.max_deg, 57.3, 0.1);
  EXPECT_NEAR(motor.median_speed_deg_s, 229.18, 0.5);
  EXPECT_NEAR(motor.deg_per_ms(), 0.22918, 5e-4);
  EXPECT_EQ(motor.reversals, 10U);
  EXPECT_EQ(motor.whole_sweeps(), 9U);
  EXPECT_NEAR(motor.median_sweep_s, 0.5, 1e-3);
  EXPECT_TRUE(motor.turns);
  EXPECT_FALSE(motor.one_way);
}

TEST(Inspect, MeasuresTheLaser) {
  const LaserSummary laser = inspect(recording_of(track(5, 0.01, triangle_rad))).laser;
  EXPECT_EQ(laser.used, 100U);
  EXPECT_EQ(laser.max_beams, 3U);
  EXPECT_NEAR(laser.first_beam_deg, -90, 1e-9);
  EXPECT_NEAR(laser.last_beam_deg, 90, 1e-9);
  EXPECT_NEAR(laser.scan_s, 0.002, 1e-12);
  EXPECT_NEAR(laser.duration_s, 2.475, 1e-9);
  EXPECT_EQ(laser.beams, 300U);
  EXPECT_EQ(laser.usable_beams, 200U);
  EXPECT_EQ(laser.median_range_m, 4);
}

TEST(Inspect, OfAnEmptyRecordingIsEmpty) {
  const RecordingSummary summary = inspect({});
  EXPECT_EQ(summary.laser.used, 0U);
  EXPECT_EQ(summary.motor.used, 0U);
}

}  // namespace
}  // namespace sweepscope
