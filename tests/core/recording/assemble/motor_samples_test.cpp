#include "core/recording/assemble/motor_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/geometry/motor_profile.hpp"
#include "core/numbers.hpp"
#include "core/offset/judgement/identifiability.hpp"

namespace sweepscope {
namespace {

constexpr double kEncoderStep_rad = 0.088 * kRadPerDeg;

/// To and fro over 180 deg, 1.93 s each way.
double triangle_rad(double time_s) {
  const double phase = std::abs(std::remainder(time_s / 1.93, 2.0));  // 0 to 1
  return std::numbers::pi * (phase - 0.5);
}

double encoded(double angle_rad) {
  return std::round(angle_rad / kEncoderStep_rad) * kEncoderStep_rad;
}

void add(RawJoint& joint, double time_s, double angle_rad) {
  const std::int64_t ns = 1'500'000'000 * kSecond_ns + std::llround(time_s * 1e9);
  joint.stamps.push_back({ns, ns});
  joint.positions.push_back(angle_rad);
}

/// A motor sampled at 100 Hz for 12 s.
RawJoint sampled(const std::function<double(double time_s)>& angle_rad) {
  RawJoint joint;
  joint.topic = "/joints";
  joint.joint = "roll";
  for (int i = 0; i < 1200; ++i) add(joint, 0.01 * i, encoded(angle_rad(0.01 * i)));
  return joint;
}

Recording assembled(const RawJoint& joint, double scan_period_s = 0.1) {
  Recording recording;
  recording.report.laser_stamps.median_period_s = scan_period_s;
  recording.epoch_ns = 1'500'000'000 * kSecond_ns;
  EXPECT_TRUE(assemble_motor(joint, recording));
  return recording;
}

bool warns_of(const Recording& recording, const std::string& part) {
  return std::ranges::any_of(recording.report.warnings, [&](const std::string& warning) {
    return warning.find(part) != std::string::npos;
  });
}

double read_every_50_ms(double time_s) {
  return triangle_rad(std::floor(time_s / 0.05 + 1e-9) * 0.05);
}

// Sampled at 100 Hz; the clock is set back by so much after so long.
RawJoint of_a_clock_set_back(double by_s, double after_s) {
  RawJoint joint = sampled(triangle_rad);
  for (std::size_t i = 0; i < joint.stamps.size(); ++i)
    if (0.01 * double(i) >= after_s) joint.stamps[i].header_ns -= std::llround(by_s * 1e9);
  return joint;
}

TEST(MotorSamples, OfAClockThatWasSetBackTheLongerSideIsUsed) {
  for (const double by_s : {1.0, 1.003}) {  // equal stamps, or others
    const Recording before = assembled(of_a_clock_set_back(by_s, 8)),
                    after = assembled(of_a_clock_set_back(by_s, 3));
    EXPECT_EQ(before.motor.time_s.front(), 0);
    EXPECT_NEAR(before.motor.time_s.back(), 8 - by_s, 0.1) << by_s;
    EXPECT_NEAR(after.motor.time_s.front(), 3, 0.1) << by_s;
    EXPECT_NEAR(after.motor.time_s.back(), 12 - by_s, 0.1) << by_s;
    for (const Recording& recording : {before, after})
      EXPECT_TRUE(warns_of(recording, "a clock was set back"));
  }
}

TEST(MotorSamples, AMotorThatIsReadTwiceAsOftenForAWhileHasNoClockThatWasSet) {
  RawJoint joint;
  joint.topic = "/joints";
  for (double time_s = 0; time_s<12; time_s += time_s> 4 && time_s < 6 ? 0.005 : 0.01)
    add(joint, time_s, encoded(triangle_rad(time_s)));
  const Recording recording = assembled(joint);
  EXPECT_EQ(recording.motor.time_s.size(), joint.stamps.size());
  EXPECT_FALSE(warns_of(recording, "a clock was set back"));
}

TEST(MotorSamples, MessagesThatAreLateAreNoClockThatWasSet) {
  RawJoint joint = sampled(triangle_rad);
  for (std::size_t i = 100; i < joint.stamps.size(); i += 100)  // one message comes after 30 others
    std::rotate(joint.stamps.begin() + std::ptrdiff_t(i), joint.stamps.begin() + std::ptrdiff_t(i) + 1,
                joint.stamps.begin() + std::ptrdiff_t(i) + 30);
  const Recording recording = assembled(joint);
  EXPECT_EQ(recording.motor.time_s.size(), 1200U);
  EXPECT_FALSE(warns_of(recording, "a clock was set back"));
}

TEST(MotorSamples, OldAnglesSentAgainAreLeftOut) {
  const Recording recording = assembled(sampled(read_every_50_ms));
  EXPECT_EQ(recording.report.motor_repeated, 960U);
  EXPECT_EQ(recording.motor.time_s.size(), 240U);
  EXPECT_TRUE(warns_of(recording, "960 of 1200 samples of joint roll on /joints repeat"));
  EXPECT_NEAR(recording.report.motor_stamps.median_period_s, 0.05, 1e-9);
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i)
    EXPECT_NEAR(recording.motor.angle_rad[i], triangle_rad(recording.motor.time_s[i]), kEncoderStep_rad);
}

// Read in step with sweeps of 2 s, the angles are the same in each, as those of stops are; but none lasts a
// scan.
TEST(MotorSamples, OldAnglesThatAreTheSameInEverySweepAreLeftOut) {
  const auto read_rad = [](double time_s) {
    return triangle_rad(std::floor(time_s / 0.05 + 1e-9) * 0.05 * 1.93 / 2);
  };
  EXPECT_EQ(assembled(sampled(read_rad)).report.motor_repeated, 960U);
}

TEST(MotorSamples, ASampleSentTwiceWhileTheMotorMovesIsLeftOut) {
  RawJoint joint = sampled(triangle_rad);
  joint.positions[50] = joint.positions[49];
  const Recording recording = assembled(joint);
  EXPECT_EQ(recording.report.motor_repeated, 1U);
  EXPECT_EQ(std::ranges::count(recording.motor.time_s, 0.5), 0);
}

TEST(MotorSamples, AnOldAngleThatTheNextOvertookIsLeftOut) {
  RawJoint joint = sampled(triangle_rad);
  for (const std::size_t i : {50U, 90U, 300U}) joint.positions[i] = joint.positions[i - 2];
  EXPECT_EQ(assembled(joint).report.motor_repeated, 3U);
}

TEST(MotorSamples, AMotorThatTurnsRoundKeepsEqualAngles) {
  const auto sine_rad = [](double time_s) { return std::sin(3 * time_s); };
  const auto held_rad = [](double time_s) { return std::clamp(triangle_rad(time_s), -1.2, 1.2); };
  for (const std::function<double(double)>& angle_rad :
       {std::function<double(double)>(triangle_rad), std::function<double(double)>(sine_rad),
        std::function<double(double)>(held_rad)}) {
    const Recording recording = assembled(sampled(angle_rad));
    EXPECT_EQ(recording.report.motor_repeated, 0U);
    EXPECT_EQ(recording.motor.time_s.size(), 1200U);
    EXPECT_TRUE(recording.report.warnings.empty());
  }
}

TEST(MotorSamples, AMotorThatGoesFromStopToStopKeepsItsRepeats) {
  // Stops of 0.2 s every 4 deg, at once or with 30 ms of motion in between.
  for (const double moves_s : {0.0, 0.03}) {
    const auto stepped_rad = [&](double time_s) {
      const double stop = std::floor(time_s / 0.2 + 1e-9), into_s = time_s - 0.2 * stop;
      const double part = moves_s > 0 ? std::min(1.0, into_s / moves_s) : 1.0;
      return 4 * kRadPerDeg *
             (std::abs(std::remainder(stop, 40.0)) * part +
              std::abs(std::remainder(stop - 1, 40.0)) * (1 - part));
    };
    EXPECT_EQ(assembled(sampled(stepped_rad)).report.motor_repeated, 0U) << moves_s;
  }
}

// Rests of 52 ms every 1.8 deg, which the encoder rounds to 1.76 or 1.848, and 7 ms of motion, in which it is
// read sometimes.
TEST(MotorSamples, AMotorInStepsKeepsTheRepeatsOfItsRests) {
  const auto stepped_rad = [](double time_s) {
    const double steps = evenly_s(std::abs(std::remainder(time_s, 8.26)), 0.059, 0.052) / 0.059;
    return 1.8 * kRadPerDeg * (steps - 35);
  };
  EXPECT_EQ(assembled(sampled(stepped_rad), 0.025).report.motor_repeated, 0U);
}

TEST(MotorSamples, AMotorSlowerThanItsEncodersStepsKeepsItsRepeats) {
  EXPECT_EQ(
      assembled(sampled([](double time_s) { return 0.03 * triangle_rad(time_s); })).report.motor_repeated,
      0U);
}

TEST(MotorSamples, OfTwoPublishersTheOneThatMovesIsUsed) {
  for (const bool named : {true, false}) {
    RawJoint joint;
    joint.topic = "/joints";
    joint.joint = "roll";
    if (named) joint.publishers = {"/driver", "/joint_state_publisher"};
    for (int i = 0; i < 600; ++i) {
      add(joint, 0.02 * i, encoded(triangle_rad(0.02 * i)));
      if (named) joint.publisher.push_back(0);
      if (i % 5 != 2) continue;
      add(joint, 0.02 * i + 0.007, 0);
      if (named) joint.publisher.push_back(1);
    }
    const Recording recording = assembled(joint);
    EXPECT_EQ(recording.report.motor_of_others, 120U) << named;
    EXPECT_EQ(recording.motor.time_s.size(), 600U) << named;
    EXPECT_TRUE(warns_of(recording, named ? "/driver (600 samples over 179.1 deg) and /joint_state_publisher"
                                          : "publishes a constant"))
        << testing::PrintToString(recording.report.warnings);
    EXPECT_FALSE(motor_faults_refusal(recording.report));
  }
}

TEST(MotorSamples, APublisherThatSendsTheLastAngleAgainIsLeftOut) {
  RawJoint joint;
  joint.publishers = {"/republisher", "/driver"};
  for (int i = 0; i < 1200; ++i) {
    const double time_s = 0.01 * i;
    if (i % 2 == 0) add(joint, time_s, encoded(triangle_rad(time_s)));
    if (i % 2 == 0) joint.publisher.push_back(1);
    if (i % 3 != 1) continue;
    add(joint, time_s + 0.004, joint.positions.back());
    joint.publisher.push_back(0);
  }
  const Recording recording = assembled(joint);
  EXPECT_EQ(recording.motor.time_s.size(), 600U);
  EXPECT_TRUE(warns_of(recording, "only the samples of /driver are used"));
}

TEST(MotorSamples, ANodeThatWasStartedAgainCountsOn) {
  RawJoint joint = sampled(triangle_rad);
  joint.publishers = {"/driver_1", "/driver_2"};
  joint.publisher.assign(700, 0);
  joint.publisher.resize(1200, 1);
  const Recording recording = assembled(joint);
  EXPECT_EQ(recording.motor.time_s.size(), 1200U);
  EXPECT_TRUE(recording.report.warnings.empty());
}

TEST(MotorSamples, TwoSourcesThatMoveDifferentlyAreRefused) {
  for (const bool named : {true, false}) {
    RawJoint joint;
    joint.topic = "/joints";
    joint.joint = "roll";
    if (named) joint.publishers = {"/driver", "/commands"};
    for (int i = 0; i < 600; ++i) {
      add(joint, 0.02 * i, encoded(triangle_rad(0.02 * i)));
      add(joint, 0.02 * i + 0.01, encoded(triangle_rad(0.02 * i + 1)));
      if (named) joint.publisher.insert(joint.publisher.end(), {0, 1});
    }
    const auto refused = motor_faults_refusal(assembled(joint).report);
    ASSERT_TRUE(refused) << named;
    EXPECT_EQ(refused->kind, RefusalKind::kTwoMotorSources);
    EXPECT_NE(
        refused->text.find(named ? "/driver (600 samples over 179.1 deg) and /commands" : "jump to and fro"),
        std::string::npos)
        << refused->text;
  }
}

TEST(MotorSamples, AnglesInDegreesAreHardlyRadians) {
  const auto deg = [](double scale) {
    return [scale](double time_s) { return scale * triangle_rad(time_s); };
  };
  const auto refused = motor_faults_refusal(assembled(sampled(deg(kDegPerRad))).report);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->kind, RefusalKind::kHardlyRadians);
  EXPECT_NE(refused->text.find("they span 10313 deg, at 53"), std::string::npos) << refused->text;
  EXPECT_NE(refused->text.find("motor: {unit: deg}"), std::string::npos);
  EXPECT_TRUE(motor_faults_refusal(assembled(sampled(deg(4096 / std::numbers::pi))).report)) << "ticks";
  EXPECT_FALSE(motor_faults_refusal(assembled(sampled(deg(1))).report));
}

TEST(MotorSamples, AMotorOfManyTurnsIsInRadians) {
  EXPECT_FALSE(motor_faults_refusal(assembled(sampled([](double time_s) { return 6 * time_s; })).report));
  const auto wrapped_rad = [](double time_s) { return std::remainder(6 * time_s, 2 * std::numbers::pi); };
  EXPECT_FALSE(motor_faults_refusal(assembled(sampled(wrapped_rad)).report));
}

}  // namespace
}  // namespace sweepscope
