#include "core/recording/assemble/beam_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/offset/estimator.hpp"
#include "core/offset/summary.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/recording/inspect.hpp"
#include "core/simulation/sensor.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

constexpr double kPeriod_s = 0.025, kBeamTruth_s = 0.0173;

/// 180 of a turn of 1440 beams, of a mirror that turns once in 25 ms.
RawScan scan_of(double increment_s, double scan_time_s = kPeriod_s) {
  RawScan scan;
  scan.angle_increment_rad = static_cast<float>(2 * std::numbers::pi / 1440);
  scan.beams = 721;
  scan.time_increment_s = static_cast<float>(increment_s);
  scan.scan_time_s = static_cast<float>(scan_time_s);
  return scan;
}
constexpr double kOfMirror_s = kPeriod_s / 1440;

TEST(BeamTimes, AnIncrementNearThatOfASteadyMirrorIsTakenAsItIs) {
  for (const double factor : {0.82, 1.0, 1.2}) {
    for (const double scan_time_s : {0.0, kPeriod_s, 1e-9}) {
      const RawScan scan = scan_of(factor * kOfMirror_s, scan_time_s);
      const BeamTimes times = judge_beam_times(scan, kPeriod_s, std::nullopt);
      EXPECT_EQ(times.finding, IncrementFinding::kSound);
      EXPECT_EQ(times.time_increment_s.value(), double{scan.time_increment_s});
      EXPECT_EQ(times.doubt_s(721), 0);
    }
  }
}

TEST(BeamTimes, ADriverThatLeavesOutScansIsBelievedWhereItsScanTimeSaysSo) {
  const RawScan skipping = scan_of(kOfMirror_s / 2, kPeriod_s / 2);
  EXPECT_EQ(judge_beam_times(skipping, kPeriod_s, std::nullopt).finding, IncrementFinding::kSound);
  for (const double scan_time_s : {0.0, kPeriod_s}) {
    const BeamTimes times = judge_beam_times(scan_of(kOfMirror_s / 2, scan_time_s), kPeriod_s, std::nullopt);
    EXPECT_EQ(times.finding, IncrementFinding::kSkipsOrTooShort);
    EXPECT_NEAR(times.time_increment_s.value(), kOfMirror_s / 2, 1e-10);
    EXPECT_NEAR(times.doubt_s(721), kPeriod_s / 4, 1e-5);
  }
}

TEST(BeamTimes, AScanThatTakesItsWholePeriodIsInDoubtExceptOfAWholeTurn) {
  const BeamTimes half = judge_beam_times(scan_of(kPeriod_s / 721), kPeriod_s, std::nullopt);
  EXPECT_EQ(half.finding, IncrementFinding::kWholePeriodOrTooLong);
  EXPECT_NEAR(half.doubt_s(721), kPeriod_s / 2, 1e-4);
  RawScan whole = scan_of(kPeriod_s / 1440);
  whole.beams = 1440;
  EXPECT_EQ(judge_beam_times(whole, kPeriod_s, std::nullopt).finding, IncrementFinding::kSound);
  whole.time_increment_s = 0;
  const BeamTimes guessed = judge_beam_times(whole, kPeriod_s, std::nullopt);
  EXPECT_NEAR(guessed.time_increment_s.value(), kOfMirror_s, 1e-9);
  EXPECT_EQ(guessed.doubt_s(1440), 0);
  whole.scan_time_s = static_cast<float>(1.2 * kPeriod_s);
  EXPECT_NEAR(judge_beam_times(whole, kPeriod_s, std::nullopt).doubt_s(1440), 0.2 * kPeriod_s, 1e-5)
      << "the stamps say otherwise";
}

TEST(BeamTimes, WhatCannotBeRightIsTheRigsElseFromAScanTimeThatCanBe) {
  for (const double increment_s : {1e-12, 1e-6, 8e-5, 0.5, 7.0, std::nan("")}) {
    const RawScan scan = scan_of(increment_s);
    const BeamTimes of_scan_time = judge_beam_times(scan, kPeriod_s, std::nullopt);
    EXPECT_NEAR(of_scan_time.time_increment_s.value(), kPeriod_s / 721, 1e-9) << increment_s;
    EXPECT_NEAR(of_scan_time.doubt_s(721), kPeriod_s / 2, 1e-4);
    const BeamTimes of_rig = judge_beam_times(scan, kPeriod_s, 2e-5);
    EXPECT_EQ(of_rig.time_increment_s.value(), 2e-5);
    EXPECT_TRUE(of_rig.of_rig);
    EXPECT_EQ(of_rig.doubt_s(721), 0);
    for (const double scan_time_s : {0.0, 1e-12, 5.0}) {  // all at once, or at the mirror's pace
      const BeamTimes unknown = judge_beam_times(scan_of(increment_s, scan_time_s), kPeriod_s, std::nullopt);
      EXPECT_EQ(unknown.time_increment_s.value(), 0);
      EXPECT_NEAR(unknown.doubt_s(721), kPeriod_s / 2, 1e-4);
    }
  }
}

TEST(BeamTimes, ARigFileThatSaysOtherwiseIsFollowed) {
  const RawScan scan = scan_of(kOfMirror_s);
  for (const double increment_s : {0.0, kOfMirror_s / 2, 2 * kOfMirror_s}) {
    const BeamTimes times = judge_beam_times(scan, kPeriod_s, increment_s);
    EXPECT_EQ(times.time_increment_s.value(), increment_s);
    EXPECT_TRUE(times.of_rig);
  }
  const BeamTimes alike = judge_beam_times(scan, kPeriod_s, 1.1 * kOfMirror_s);
  EXPECT_EQ(alike.time_increment_s.value(), double{scan.time_increment_s});
  EXPECT_FALSE(alike.of_rig);
}

TEST(BeamTimes, WithoutAPeriodIncrementsAreNotJudged) {
  EXPECT_EQ(judge_beam_times(scan_of(1e-12), 0, std::nullopt).finding, IncrementFinding::kSound);
  std::vector<RawScan> scans(9);
  for (std::size_t i = 0; i < scans.size(); ++i)
    scans[i].stamps.header_ns = 1'000'000'000 + static_cast<std::int64_t>(i) * 25'000'000;
  EXPECT_NEAR(scan_period_s(scans, StampSource::kHeader), 0.025, 1e-9);
  EXPECT_EQ(scan_period_s(scans, StampSource::kReceive), 0);
  scans.pop_back();
  EXPECT_EQ(scan_period_s(scans, StampSource::kHeader), 0);
}

/// A room as its bag holds it, with every time_increment times a factor.
Result<Recording> room(double factor, const Rig& rig = {}) {
  const Recording& made = test::simulated("room-1", kBeamTruth_s, 4.5).recording;
  RawRecording raw;
  raw.file = raw.name = "room.bag";
  RawLaser& laser = raw.lasers.emplace_back();
  laser.topic = "/scan";
  laser.ranges_m = made.ranges_m;
  laser.has_intensities = false;
  for (const LaserScan& from : made.scans) {
    RawScan& scan = laser.scans.emplace_back();
    scan.stamps.header_ns = made.epoch_ns + std::llround(from.first_beam_s * 1e9);
    scan.angle_min_rad = static_cast<float>(from.angle_min_rad);
    scan.angle_increment_rad = static_cast<float>(from.angle_increment_rad);
    scan.time_increment_s = static_cast<float>(factor * from.time_increment_s);
    scan.scan_time_s = static_cast<float>(simulation::Scanner{}.scan_period_s);
    scan.first_range = from.first_range;
    scan.beams = from.beams;
  }
  RawJoint& joint = raw.joints.emplace_back();
  joint.topic = "/joint_states";
  joint.joint = "roll_motor";
  joint.positions = made.motor.angle_rad;
  for (const double time_s : made.motor.time_s)
    joint.stamps.push_back({made.epoch_ns + std::llround(time_s * 1e9), 0});
  return assemble(std::move(raw), rig, std::nullopt);
}

Estimate estimated(const Recording& recording, Method method) {
  EstimateOptions options;
  options.method = method;
  return estimate(recording, options, Job()).value();
}

TEST(BeamTimes, RightOnesAreNotInDoubt) {
  const Recording recording = room(1).value();
  EXPECT_EQ(recording.report.beam_time_doubt_s, 0);
  EXPECT_TRUE(recording.report.warnings.empty());
  const Estimate found = estimated(recording, Method::kDirect);
  ASSERT_TRUE(found.offset_s);
  EXPECT_NEAR(*found.offset_s, kBeamTruth_s, 1e-4);
}

TEST(BeamTimes, WrongOnesGiveNoAnswerThatIsSureAndWrong) {
  for (const double factor : {1e-12 / 1.736e-5, 1e-3, 0.5, 2.0, 3.0, 0.0}) {
    const Recording recording = room(factor).value();
    ASSERT_EQ(recording.report.warnings.size(), 1U) << factor;
    EXPECT_NE(recording.report.warnings[0].find("laser.time_increment_s"), std::string::npos);
    const Estimate direct = estimated(recording, Method::kDirect);
    EXPECT_FALSE(direct.identifiable) << factor;
    EXPECT_EQ(direct.reasons().at(0).find("When the beams were fired is not known"), 0U)
        << direct.reasons()[0];
    std::string expectations;
    for (const std::string& line :
         sweepscope::expectations(recording, inspect(recording), find_sweeps(recording.motor)))
      expectations += line + "\n";
    EXPECT_NE(expectations.find("Expect a refusal: when the beams were fired is not known"),
              std::string::npos)
        << expectations;
  }
}

TEST(BeamTimes, ThePapersMethodSaysHowUnsureItIs) {
  for (const double factor : {1e-7, 0.5, 2.0}) {
    const Estimate found = estimated(room(factor).value(), Method::kStationary);
    ASSERT_TRUE(found.offset_s) << factor << testing::PrintToString(found.reasons());
    ASSERT_TRUE(found.sigma_s);
    EXPECT_LT(std::abs(*found.offset_s - kBeamTruth_s), 3 * *found.sigma_s) << factor;
    EXPECT_GT(*found.sigma_s, 1e-3);
  }
}

TEST(BeamTimes, TheRigFileTakesTheDoubtAway) {
  Rig rig;
  rig.laser.time_increment_s = simulation::Scanner{}.increment_s();
  for (const double factor : {1e-7, 0.5, 2.0, 0.0}) {
    const Recording recording = room(factor, rig).value();
    EXPECT_EQ(recording.report.beam_time_doubt_s, 0);
    EXPECT_EQ(recording.report.warnings.size(), factor > 0 ? 1U : 0U);
    const Estimate found = estimated(recording, Method::kDirect);
    ASSERT_TRUE(found.offset_s);
    EXPECT_NEAR(*found.offset_s, kBeamTruth_s, 1e-4);
  }
}

TEST(BeamTimes, BeamsInTheOtherDirectionOfTimeKeepTheirStamp) {
  for (const double factor : {-1.0, -1e-7}) {
    Rig rig;
    rig.laser.time_increment_s = simulation::Scanner{}.increment_s();
    const Recording recording = room(factor, rig).value();
    EXPECT_EQ(recording.report.beam_time_doubt_s, 0);
    const Recording plain = room(1).value();
    const LaserScan &turned = recording.scans.at(3), &sound = plain.scans.at(3);
    EXPECT_NEAR(turned.last_beam_s(), sound.first_beam_s, 1e-8);
    EXPECT_NEAR(turned.time_increment_s, sound.time_increment_s, 1e-11);
  }
}

}  // namespace
}  // namespace sweepscope
