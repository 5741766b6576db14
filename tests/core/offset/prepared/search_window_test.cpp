#include "core/offset/prepared/search_window.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kDegree;
using test::kMs;
using test::kPi;

MotorMotion turning(double sweep_s, double speed_rad_s) {
  MotorMotion motion;
  motion.sweeps.resize(4);
  motion.median_sweep_s = motion.mirror_shift_s = sweep_s;
  motion.median_speed_rad_s = speed_rad_s;
  return motion;
}

TEST(SearchScale, LooksSixtyMillisecondsToEitherSide) {
  const SearchScale scale = search_scale(turning(0.5, 360 * kDegree));
  EXPECT_NEAR(scale.half_width_s, 60 * kMs, 1e-12);
  EXPECT_NEAR(scale.unit_s, 1 * kMs, 1e-12);
  EXPECT_NEAR(scale.max_half_width_s, 0.25, 1e-12);
}

TEST(SearchScale, ASlowMotorIsSearchedAsFarAsItTurnsFiveDegrees) {
  const SearchScale scale = search_scale(turning(6, 30 * kDegree));
  EXPECT_NEAR(scale.half_width_s, 5.0 / 30, 1e-9);
  EXPECT_NEAR(scale.unit_s, 20 * kMs, 1e-9);  // 0.36 deg take 12 ms
}

TEST(SearchScale, IsNeverWiderThanAQuarterOfThePeriod) {
  EXPECT_NEAR(search_scale(turning(0.08, 360 * kDegree)).half_width_s, 40 * kMs, 1e-12);
}

TEST(SearchScale, IsAsWideAsAnUnevenMotorTellsOffsetsApart) {
  MotorMotion motion = turning(0.5, 360 * kDegree);
  motion.mirror_shift_s = 1.5;
  EXPECT_NEAR(search_scale(motion).max_half_width_s, 0.75, 1e-12);
  EXPECT_NEAR(search_scale(motion).half_width_s, 60 * kMs, 1e-12);
}

class CheckedOffsets : public testing::Test {
 protected:
  static void expect_refused(const std::vector<OffsetRange>& ranges, const char* part_of_message) {
    const auto result = checked_offsets(ranges, search_scale(turning(0.5, 360 * kDegree)));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::kWrongUsage);
    EXPECT_NE(result.error().message.find(part_of_message), std::string::npos) << result.error().message;
  }
};

TEST_F(CheckedOffsets, ARangeOfAQuarterPeriodToEitherSideIsAccepted) {
  const auto offsets_s = checked_offsets({{-250 * kMs, 250 * kMs, 10 * kMs}}, search_scale(turning(0.5, 6)));
  ASSERT_TRUE(offsets_s);
  EXPECT_EQ(offsets_s->size(), 51u);
}

TEST_F(CheckedOffsets, AWiderRangeIsWrongUsageAndSaysWhy) {
  expect_refused({{-252 * kMs, 252 * kMs, 1 * kMs}}, "mirror image");
  expect_refused({{0, 10 * kMs, 1 * kMs}, {500 * kMs, 511 * kMs, 1 * kMs}}, "this motor allows 250.0 ms");
}

TEST_F(CheckedOffsets, RangesWithoutACandidateAreWrongUsage) {
  expect_refused({}, "no candidate");
  expect_refused({{10 * kMs, 0, 1 * kMs}}, "FROM <= TO");
  expect_refused({{0, 10 * kMs, 0}}, "STEP above 0");
  expect_refused({{0, std::nan(""), kMs}}, "FROM <= TO");
  expect_refused({{-200 * kMs, 200 * kMs, 1e-9}}, "100000");
}

// Scans of 10 ms every 100 ms from 0 to 1.9 s; the motor's track from 0.3 to 1.5 s.
class ScansCovered : public testing::Test {
 protected:
  ScansCovered() {
    for (int i = 0; i < 20; ++i) recording_.scans.push_back({0.1 * i, 1e-4, 0, 0, 0, 101});
    recording_.motor = test::track_of([](double t_s) { return t_s; }, 0.299, 1.519);
  }
  std::ptrdiff_t covered(double min_s, double max_s) const {
    const std::vector<char> used = scans_covered(recording_, min_s, max_s);
    return std::count(used.begin(), used.end(), 1);
  }
  Recording recording_;
};

TEST_F(ScansCovered, AreThoseInsideTheTrack) {
  EXPECT_EQ(covered(0, 0), 13);
}

TEST_F(ScansCovered, AtEveryOffsetSearched) {
  EXPECT_EQ(covered(0, 0.1), 12);
  EXPECT_EQ(covered(-0.1, 0.1), 11);
}

TEST_F(ScansCovered, NotThoseInAGapOfTheTrack) {
  MotorTrack& motor = recording_.motor;
  const auto in_gap = [&](double t_s) { return t_s > 0.75 && t_s < 0.95; };
  MotorTrack with_gap;
  for (std::size_t i = 0; i < motor.time_s.size(); ++i) {
    if (in_gap(motor.time_s[i])) continue;
    with_gap.time_s.push_back(motor.time_s[i]);
    with_gap.angle_rad.push_back(motor.angle_rad[i]);
  }
  motor = with_gap;
  EXPECT_EQ(covered(0, 0), 11);  // without those at 0.8 and 0.9 s
}

TEST(PrepareProblem, HoldsWhatAllOffsetsShare) {
  const Recording& recording = test::room(0.024);
  const OffsetProblem problem = test::problem_of(recording);
  EXPECT_EQ(problem.recording, &recording);
  EXPECT_EQ(problem.scan_used.size(), recording.scans.size());
  EXPECT_NEAR(problem.motor.median_sweep_s, 0.5, 2e-3);
  EXPECT_GT(problem.features->planes.features.size(), 1000u);
}

}  // namespace
}  // namespace sweepscope
