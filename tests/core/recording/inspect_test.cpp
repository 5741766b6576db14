#include "core/recording/inspect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace sweepscope {
namespace {

MotorTrack track(double duration_s, double period_s, const std::function<double(double)>& angle_rad) {
  MotorTrack motor;
  for (int i = 0; i * period_s <= duration_s; ++i) {
    motor.time_s.push_back(i * period_s);
    motor.angle_rad.push_back(angle_rad(i * period_s));
  }
  return motor;
}

/// Between -1 and 1 rad, half a second each way, at -1 at 0 s.
double triangle_rad(double t_s) {
  const double phase = std::fmod(t_s, 1.0);
  return phase < 0.5 ? -1 + 4 * phase : 3 - 4 * phase;
}

Recording recording_of(const MotorTrack& motor) {
  Recording recording;
  recording.name = "a.bag";
  recording.motor = motor;
  for (int i = 0; i < 100; ++i) {
    LaserScan scan;
    scan.first_beam_s = 0.025 * i;
    scan.time_increment_s = 0.001;
    scan.angle_min_rad = -std::numbers::pi / 2;
    scan.angle_increment_rad = std::numbers::pi / 2;
    scan.first_range = recording.ranges_m.size();
    scan.beams = 3;
    recording.ranges_m.insert(recording.ranges_m.end(), {2, 4, std::numeric_limits<float>::quiet_NaN()});
    recording.scans.push_back(scan);
  }
  return recording;
}

std::string expectations(const Recording& recording) {
  std::string all;
  for (const std::string& line : inspect(recording).expectations) all += line + "\n";
  return all;
}

TEST(Inspect, MeasuresTheMotor) {
  const MotorSummary motor = inspect(recording_of(track(5.2, 0.01, triangle_rad))).motor;
  EXPECT_NEAR(motor.least_deg, -57.3, 0.1);
  EXPECT_NEAR(motor.most_deg, 57.3, 0.1);
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
  EXPECT_EQ(laser.most_beams, 3U);
  EXPECT_NEAR(laser.first_beam_deg, -90, 1e-9);
  EXPECT_NEAR(laser.last_beam_deg, 90, 1e-9);
  EXPECT_NEAR(laser.scan_s, 0.002, 1e-12);
  EXPECT_NEAR(laser.duration_s, 2.475, 1e-9);
  EXPECT_EQ(laser.beams, 300U);
  EXPECT_EQ(laser.usable_beams, 200U);
  EXPECT_EQ(laser.median_range_m, 4);
}

TEST(Inspect, SaysWhatAnEstimateCanHopeFor) {
  const std::string text = expectations(recording_of(track(5.2, 0.01, triangle_rad)));
  EXPECT_NE(text.find("1 ms of offset turns a scan by 0.229 deg: 16 mm at the median range of 4 m."),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("Offsets up to 250 ms to either side"), std::string::npos) << text;
  EXPECT_NE(text.find("9 whole sweeps are enough of a standing rig"), std::string::npos) << text;
}

TEST(Inspect, ExpectsARefusalOfSweepsThatSeeTheSameFewLines) {
  Recording recording = recording_of(track(5.2, 0.01, triangle_rad));
  EXPECT_EQ(expectations(recording).find("scan lines"), std::string::npos);
  for (LaserScan& scan : recording.scans) scan.first_beam_s *= 4;
  EXPECT_NE(expectations(recording).find("Expect a refusal: all sweeps of a direction see the same 5 scan"),
            std::string::npos)
      << expectations(recording);
  EXPECT_EQ(expectations(recording).find("Expect an offset"), std::string::npos);
}

TEST(Inspect, SaysWhatFewSamplesOfTheMotorCost) {
  const auto sampled_every = [](double period_s) {
    Recording recording = recording_of(track(5.2, 0.01, triangle_rad));
    recording.report.motor_stamps.median_period_s = period_s;
    return expectations(recording);
  };
  EXPECT_EQ(sampled_every(0.01).find("is sampled"), std::string::npos);
  EXPECT_NE(sampled_every(0.1).find("sampled 5.0 times a sweep only, which costs accuracy: sample it every "
                                    "0.031 s."),
            std::string::npos)
      << sampled_every(0.1);
  EXPECT_NE(sampled_every(0.2).find("Expect a refusal: the motor is sampled 2.5 times"), std::string::npos);
  EXPECT_EQ(sampled_every(0.2).find("Expect an offset"), std::string::npos);
}

TEST(Inspect, SaysWhatMakesAnEstimateImpossible) {
  EXPECT_EQ(expectations(recording_of(track(5, 0.01, [](double) { return 1.0; }))),
            "The motor does not turn: there is no offset to see.\n");
  EXPECT_NE(expectations(recording_of(track(5, 0.01, [](double t_s) { return 3 * t_s; })))
                .find("turns one way only"),
            std::string::npos);
  EXPECT_NE(expectations(recording_of(track(5, 0.01, [](double t_s) { return 0.1 * t_s; })))
                .find("never turns back"),
            std::string::npos);
}

TEST(Inspect, OfAnEmptyRecordingIsEmpty) {
  const RecordingSummary summary = inspect({});
  EXPECT_EQ(summary.laser.used, 0U);
  EXPECT_EQ(summary.motor.used, 0U);
}

}  // namespace
}  // namespace sweepscope
