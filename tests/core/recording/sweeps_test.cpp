#include "core/recording/sweeps.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using simulation::Motor;
using simulation::MotorKind;
using test::kDegree;
using test::kPi;
using test::track_of;

// With phase 0 the motor passes 0 upwards at t = 0: sweeps of 0.5 s are cut at 0.25, 0.75, 1.25, ... s.
MotorTrack turning(MotorKind kind, double from_s, double to_s) {
  return track_of([motor = Motor(kind, 0.5, 0)](double t_s) { return motor.angle_rad(t_s); }, from_s, to_s);
}

void expect_cuts(const MotorMotion& motion, double first_cut_s, double tolerance_s) {
  for (std::size_t i = 1; i < motion.sweeps.size(); ++i) {
    const Sweep &before = motion.sweeps[i - 1], &after = motion.sweeps[i];
    EXPECT_NEAR(after.begin_s, first_cut_s + 0.5 * double(i - 1), tolerance_s) << i;
    EXPECT_EQ(before.end_s, after.begin_s) << i;
    EXPECT_EQ(before.direction, -after.direction) << i;
  }
}

class FindSweeps : public testing::TestWithParam<MotorKind> {};

TEST_P(FindSweeps, CutsAtTheReversalsAndKeepsThePartialEnds) {
  const MotorMotion motion = find_sweeps(turning(GetParam(), 0, 4.1));
  ASSERT_EQ(motion.sweeps.size(), 9u);  // half a sweep, seven whole ones, and the last from 3.75 s on
  expect_cuts(motion, 0.25, 1e-3);
  EXPECT_EQ(motion.sweeps.front().direction, 1);
  EXPECT_NEAR(motion.sweeps.front().begin_s, 0, 0.02);
  EXPECT_NEAR(motion.sweeps.back().end_s, 4.1, 0.02);
  EXPECT_NEAR(motion.range_rad, kPi, 0.05);
  EXPECT_NEAR(motion.median_sweep_s, 0.5, 1e-3);
}

TEST_P(FindSweeps, TheSteadyPartKeepsOffTheReversals) {
  for (const Sweep& sweep : find_sweeps(turning(GetParam(), 0, 4.1)).sweeps) {
    EXPECT_LT(sweep.begin_s, sweep.steady_begin_s + 1e-9);
    EXPECT_LT(sweep.steady_begin_s, sweep.steady_end_s);
    EXPECT_LT(sweep.steady_end_s, sweep.end_s + 1e-9);
  }
}

// Stepped like the paper's encoder, and far more coarsely: 0.3 deg with noise of as much.
TEST_P(FindSweeps, StepsAndNoiseAreNotReversals) {
  simulation::Random random(1, 7, 0);
  for (const double step_deg : {0.088, 0.3}) {
    MotorTrack track = turning(GetParam(), 0, 4.1);
    for (double& angle_rad : track.angle_rad) {
      const double noisy_deg = angle_rad / kDegree + step_deg * random.normal();
      angle_rad = std::floor(noisy_deg / step_deg + 0.5) * step_deg * kDegree;
    }
    const MotorMotion motion = find_sweeps(track);
    ASSERT_EQ(motion.sweeps.size(), 9u) << step_deg;
    expect_cuts(motion, 0.25, 2e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(MotorKinds, FindSweeps,
                         testing::Values(MotorKind::kTriangle, MotorKind::kTrapezoid, MotorKind::kSine),
                         [](const auto& kind) { return std::string(simulation::name_of(kind.param)); });

TEST(FindSweeps, TheMedianSpeedIsTheMotorsOwn) {
  EXPECT_NEAR(find_sweeps(turning(MotorKind::kTriangle, 0, 4)).median_speed_rad_s, kPi / 0.5, 0.01);
  // A trapezoid spends 0.16 of a sweep on reversals: pi / (0.5 * (1 - 0.08)).
  EXPECT_NEAR(find_sweeps(turning(MotorKind::kTrapezoid, 0, 4)).median_speed_rad_s, kPi / 0.46, 0.25);
}

TEST(FindSweeps, ARestBeforeTheStartBelongsToNoSweep) {
  const Motor motor(MotorKind::kTriangle, 0.5, 0.25);
  const MotorMotion motion =
      find_sweeps(track_of([&](double t_s) { return t_s < 2 ? -kPi / 2 : -motor.angle_rad(t_s - 2); }, 0, 5));
  ASSERT_EQ(motion.sweeps.size(), 6u);
  EXPECT_NEAR(motion.sweeps.front().begin_s, 2.0, 0.03);
  EXPECT_EQ(motion.sweeps.front().direction, 1);
  expect_cuts(motion, 2.5, 1e-3);
}

TEST(FindSweeps, ALongRestBetweenSweepsBelongsToNone) {
  const Motor motor(MotorKind::kTriangle, 0.5, 0.25);
  const auto moved_s = [](double t_s) { return t_s < 1 ? t_s : std::max(1.0, t_s - 3); };
  const MotorMotion motion =
      find_sweeps(track_of([&](double t_s) { return motor.angle_rad(moved_s(t_s)); }, 0, 6));
  std::size_t resting = 0;
  for (const Sweep& sweep : motion.sweeps)
    if (sweep.begin_s < 2.5 && sweep.end_s > 2.5) ++resting;
  EXPECT_EQ(resting, 0u);
  EXPECT_EQ(motion.sweeps.size(), 6u);
}

// A motor that turns one way, from one speed (deg/s) to the other, over 8 s.
MotorTrack turning_on(double first_dps, double last_dps, bool ramp, double sign = 1) {
  const simulation::SpeedCourse course{{first_dps * kDegree, last_dps * kDegree}, ramp, 8};
  const Motor motor(MotorKind::kOneWay, 0.5, 0, {}, course);
  return track_of([&](double t_s) { return sign * motor.angle_rad(t_s); }, 0, 7.9);
}

TEST(FindSweeps, AMotorThatTurnsOneWayIsCutWhereItsAnglePassesHalfTurns) {
  for (const double sign : {1.0, -1.0}) {
    const MotorTrack track = turning_on(360, 180, false, sign);
    const MotorMotion motion = find_sweeps(track);
    EXPECT_TRUE(motion.one_way());
    ASSERT_EQ(motion.sweeps.size(), 13U);  // 2160 deg less a little, the first and the last half turn cut off
    for (std::size_t i = 0; i + 1 < motion.sweeps.size(); ++i) {
      EXPECT_EQ(motion.sweeps[i].direction, sign);
      EXPECT_EQ(motion.sweeps[i].end_s, motion.sweeps[i + 1].begin_s);
      EXPECT_NEAR(std::remainder(track.angle_at(motion.sweeps[i].end_s), kPi), 0, 1e-6);
    }
  }
}

TEST(FindSweeps, HalfTurnsArePartedIntoFasterAndSlowerOnes) {
  const MotorMotion steps = find_sweeps(turning_on(360, 180, false));
  for (const Sweep& sweep : steps.sweeps)
    EXPECT_EQ(sweep.side, sweep.begin_s < 3.8 ? 1 : -1) << sweep.begin_s;
  EXPECT_NEAR(steps.speeds_apart_rad_s(), kPi, 0.1 * kPi);  // a half turn changes from one to the other
  EXPECT_EQ(steps.lever_speed_rad_s(), steps.speeds_apart_rad_s() / 2);
  const MotorMotion ramp = find_sweeps(turning_on(180, 360, true));
  EXPECT_NEAR(ramp.speeds_apart_rad_s(), 0.5 * kPi, 0.05 * kPi);  // of the halves' mean speeds
  EXPECT_LT(find_sweeps(turning_on(360, 360, false)).speeds_apart_rad_s(), 1e-3);
}

TEST(FindSweeps, AMotorThatTurnsToAndFroIsNotOneWay) {
  const MotorMotion motion = find_sweeps(turning(MotorKind::kTriangle, 0, 4));
  EXPECT_FALSE(motion.one_way());
  EXPECT_EQ(motion.lever_speed_rad_s(), motion.median_speed_rad_s);
  for (const Sweep& sweep : motion.sweeps) EXPECT_EQ(sweep.side, sweep.direction);
}

TEST(FindSweeps, AJumpOfManyTurnsIsNoMotorThatTurnsOneWay) {
  const MotorMotion motion = find_sweeps(track_of([](double t_s) { return t_s < 2 ? 0 : 1e300; }, 0, 4));
  EXPECT_FALSE(motion.one_way());
}

TEST(FindSweeps, AStuckMotorHasNoSweepThoughItsEncoderJitters) {
  EXPECT_TRUE(find_sweeps(turning(MotorKind::kStuck, 0, 4)).sweeps.empty());
  const auto jitter = [](double t_s) { return (double(std::lround(t_s * 100) % 3) - 1) * 0.088 * kDegree; };
  EXPECT_TRUE(find_sweeps(track_of(jitter, 0, 4)).sweeps.empty());
}

TEST(FindSweeps, ATrackOfTwoSamplesIsNoMotion) {
  EXPECT_TRUE(find_sweeps(MotorTrack{{0, 1}, {0, 1}}).sweeps.empty());
}

class AssignSweeps : public testing::Test {
 protected:
  // 100 beams over 9.9 ms, from 5 ms before `middle_s`.
  static LaserScan scan_about(double middle_s) { return {middle_s - 0.00495, 1e-4, 0, 0.01, 0, 100}; }
  static std::size_t sweep_at(double middle_s, double offset_s) {
    const std::vector<Sweep> sweeps = {{0.5, 1.0, 0.5, 1.0, 1, 1}, {1.0, 1.5, 1.0, 1.5, -1, 1}};
    return assign_sweeps({scan_about(middle_s)}, sweeps, offset_s).front();
  }
};

TEST_F(AssignSweeps, GoesByTheMiddleOfTheBeams) {
  EXPECT_EQ(sweep_at(0.999, 0), 0u);
  EXPECT_EQ(sweep_at(1.001, 0), 1u);
}

TEST_F(AssignSweeps, ScansOutsideEverySweepHaveNone) {
  EXPECT_EQ(sweep_at(0.499, 0), kNoSweep);
  EXPECT_EQ(sweep_at(1.501, 0), kNoSweep);
}

// t_motor = t_laser + offset: with a positive offset a scan belongs to a later part of the motor's track.
TEST_F(AssignSweeps, APositiveOffsetMovesScansToLaterSweeps) {
  EXPECT_EQ(sweep_at(0.990, 0.009), 0u);
  EXPECT_EQ(sweep_at(0.990, 0.011), 1u);
  EXPECT_EQ(sweep_at(1.010, -0.009), 1u);
  EXPECT_EQ(sweep_at(1.010, -0.011), 0u);
}

TEST_F(AssignSweeps, KeepsTheOrderOfScans) {
  std::vector<LaserScan> scans;
  scans.reserve(60);
  for (int i = 0; i < 60; ++i) scans.push_back(scan_about(0.4 + 0.02 * i));
  const auto assigned = assign_sweeps(scans, {{0.5, 1.0, 0.5, 1.0, 1, 1}, {1.0, 1.5, 1.0, 1.5, -1, 1}}, 0);
  EXPECT_EQ(std::count(assigned.begin(), assigned.end(), 0u), 25);
  EXPECT_EQ(std::count(assigned.begin(), assigned.end(), 1u), 25);
}

// Scans every 25 ms against sweeps that take so many of them.
double lines_of(double scans_a_sweep) {
  const double sweep_s = 0.025 * scans_a_sweep;
  const Motor motor(MotorKind::kTriangle, sweep_s, 0);
  Recording recording;
  recording.motor = track_of([&](double t_s) { return motor.angle_rad(t_s); }, 0, 6, 1000);
  for (int i = 0; i < 240; ++i) recording.scans.emplace_back().first_beam_s = 0.025 * i;
  return distinct_lines(recording, find_sweeps(recording.motor), 0.003);
}

TEST(DistinctLines, CountPlacesThatSweepsShareOnce) {
  EXPECT_NEAR(lines_of(4), 4, 0.1);
  EXPECT_NEAR(lines_of(20), 20, 0.5);
  EXPECT_NEAR(lines_of(4.5), 4.5, 0.1);  // those of the other direction lie between
  EXPECT_GT(lines_of(4.3), 20);
  EXPECT_GT(lines_of(20.3), 60);
}

// Steps of 7.2 deg, each 77 ms of rest and 7 ms of motion; a sweep of 2.1 s.
Recording in_steps() {
  Recording recording;
  recording.motor = track_of(
      [](double t_s) {
        const double steps = evenly_s(std::abs(std::remainder(t_s, 4.2)), 0.084, 0.077) / 0.084;
        return 7.2 * kRadPerDeg * (steps - 12.5);
      },
      0, 13, 1000);
  for (int i = 0; i < 520; ++i) recording.scans.emplace_back().first_beam_s = 0.025 * i;
  return recording;
}

TEST(LineSpacing, IsFromScanToScan) {
  for (const MotorKind kind : {MotorKind::kTriangle, MotorKind::kTrapezoid, MotorKind::kSine}) {
    Recording recording;
    recording.motor = turning(kind, 0, 9.3);
    for (int i = 0; i < 370; ++i) recording.scans.emplace_back().first_beam_s = 0.025 * i;
    const MotorMotion motion = find_sweeps(recording);
    EXPECT_NEAR(line_spacing_rad(recording, motion), motion.median_speed_rad_s * 0.025, 1e-9) << int(kind);
  }
}

TEST(LineSpacing, OfAMotorInStepsIsAboutAStep) {
  const Recording recording = in_steps();
  const MotorMotion motion = find_sweeps(recording);
  EXPECT_NEAR(line_spacing_rad(recording, motion), 7.2 * kRadPerDeg, 0.1 * kRadPerDeg);
  EXPECT_NEAR(distinct_lines(recording, motion, 0), 25, 2);
}

// With a rest at one reversal and half a step at the other the mirror image has other rests.
TEST(MirrorShift, OfAProfileWhoseReversalLiesWithinAStepIsItsPeriod) {
  for (const double steps_per_turn : {50.0, 48.0}) {  // 12.5 and 12 for 90 deg
    Recording recording = in_steps();
    recording.rig.motor.profile = MotorProfile{.turns_per_s = 0.2,
                                               .between = {{-45, 45}},
                                               .steps_per_turn = steps_per_turn,
                                               .dwell_s = 0.05,
                                               .start_s = {}};
    const MotorMotion motion = find_sweeps(recording);
    EXPECT_EQ(motion.mirror_shift_s, (steps_per_turn == 50 ? 2 : 1) * motion.median_sweep_s)
        << steps_per_turn;
  }
}

TEST(DistinctLines, AreWithoutBoundFor3DScanners) {
  Recording recording;
  recording.directions.resize(1);
  EXPECT_EQ(distinct_lines(recording, MotorMotion(), 0), std::numeric_limits<double>::infinity());
}

// Ten seconds of sweeps of 0.5 s.
MotorTrack resting(double at_s, double rest_s) {
  const Motor motor(MotorKind::kTrapezoid, 0.5, 0.1, {}, {}, kPi / 2, {at_s, at_s + rest_s});
  return track_of([&](double t_s) { return motor.angle_rad(t_s); }, 0, 10);
}

TEST(MirrorShift, IsASweepOfAnEvenMotor) {
  for (const MotorKind kind : {MotorKind::kTriangle, MotorKind::kTrapezoid, MotorKind::kSine})
    EXPECT_EQ(find_sweeps(turning(kind, 0, 9.3)).mirror_shift_s,
              find_sweeps(turning(kind, 0, 9.3)).median_sweep_s);
  const Motor uneven(MotorKind::kTrapezoid, 0.5, 0.1, {0.03, 7});
  const MotorMotion motion = find_sweeps(track_of([&](double t_s) { return uneven.angle_rad(t_s); }, 0, 9));
  EXPECT_EQ(motion.mirror_shift_s, motion.median_sweep_s);
}

TEST(MirrorShift, IsLongerWhereTheMotorRests) {
  for (const double at_s : {0.0, 4.0, 8.0})
    EXPECT_GE(find_sweeps(resting(at_s, 2)).mirror_shift_s, 2 * 0.49) << at_s;
  EXPECT_NEAR(find_sweeps(resting(0, 0.05)).mirror_shift_s, 0.5, 0.01);
}

TEST(MirrorShift, IsLongerWhereTheMotorChangesItsSpeed) {
  const Motor motor(MotorKind::kTrapezoid, 0.5, 0.1);
  const auto angle_rad = [&](double t_s) { return motor.angle_rad(t_s < 4 ? t_s : 4 + 0.7 * (t_s - 4)); };
  EXPECT_GE(find_sweeps(track_of(angle_rad, 0, 9)).mirror_shift_s, 2 * 0.49);
}

}  // namespace
}  // namespace sweepscope
