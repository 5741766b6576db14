#include "core/offset/search/stationary_part.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "core/offset/estimator.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/results/estimate_json.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kPartTruth_s = 0.024, kStationary_s = 8.0;

Recording in_a_hall(double sweep_s, double stationary_s, double duration_s) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.duration_s = duration_s;
  bench.sweep_s = sweep_s;
  bench.offset_s = kPartTruth_s;
  bench.noise_m = 0.005;
  bench.world_from_base = [=](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.4 * std::max(0.0, t_s - stationary_s), 0, 0));
  };
  return bench.record();
}

// In a hall; it is stationary for 8 s and goes at 0.4 m/s from then on, or from the beginning.
const Recording& recorded(double sweep_s, double stationary_s = kStationary_s, double duration_s = 12) {
  static std::map<std::array<double, 3>, Recording> made;
  const std::array key{sweep_s, stationary_s, duration_s};
  if (!made.contains(key)) made.emplace(key, in_a_hall(sweep_s, stationary_s, duration_s));
  return made.at(key);
}

MotionCourse course_of(const Recording& recording) {
  return motion_course(prepare(recording, FeatureOptions(), Job()).value(), Job());
}

TEST(StationaryPart, EndsWhereTheScanLinesShowMotion) {
  for (const double sweep_s : {0.7, 1.1, 1.5}) {
    const MotionCourse course = course_of(recorded(sweep_s));
    ASSERT_TRUE(course.stationary) << sweep_s;
    EXPECT_EQ(course.stationary->begin_s, 0) << sweep_s;
    EXPECT_LE(course.stationary->end_s, kStationary_s + 0.1) << sweep_s;
    EXPECT_GT(course.stationary->end_s, kStationary_s - 0.5 * sweep_s) << sweep_s;
    ASSERT_GE(course.parts.size(), 2U) << sweep_s;
    EXPECT_FALSE(course.parts.front().moved) << sweep_s;
    EXPECT_EQ(course.parts.front().end_s, course.stationary->end_s) << sweep_s;
    EXPECT_TRUE(course.parts.back().moved) << sweep_s;
  }
}

TEST(StationaryPart, IsNoneOfARigThatMovesAllTheTime) {
  for (const double sweep_s : {0.7, 3.1}) EXPECT_FALSE(course_of(recorded(sweep_s, 0)).stationary) << sweep_s;
}

TEST(StationaryPart, IsNoneWhereItIsTooShort) {
  EXPECT_FALSE(course_of(recorded(0.7, 2)).stationary);
}

TEST(StationaryPart, AnswersAsItsWindowDoesWhereTheWalkIsTooShort) {
  for (const double sweep_s : {0.7, 1.1}) {
    const Recording& recording = recorded(sweep_s);
    const auto found = estimate(recording, {}, Job());
    ASSERT_TRUE(found && found->identifiable) << sweep_s;
    ASSERT_TRUE(found->stationary_part) << sweep_s;
    EXPECT_EQ(found->kind, RigKind::kStationary);
    EXPECT_NEAR(*found->offset_s, kPartTruth_s, 0.3 * kMs) << sweep_s;
    ASSERT_FALSE(found->warnings.empty());
    EXPECT_NE(found->warnings.front().find("in which the rig was stationary"), std::string::npos);

    const RecordingPart part = *found->stationary_part;
    Estimate as_window = estimate(window(recording, part.begin_s, part.end_s), {}, Job()).value();
    EXPECT_EQ(as_window.offset_s, found->offset_s);
    EXPECT_EQ(as_window.sigma_s, found->sigma_s);
    const auto again = parse_estimate_json(estimate_to_json(*found, Timing::kNull), "again").value();
    ASSERT_TRUE(again.stationary_part);
    EXPECT_EQ(again.stationary_part->end_s, part.end_s);
  }
}

TEST(StationaryPart, OfAWindowIsOneOfTheWholeRecording) {
  const Recording &whole = recorded(0.7), later = window(whole, 1, 12);
  const auto found = estimate(later, {}, Job());
  ASSERT_TRUE(found && found->identifiable && found->stationary_part);
  EXPECT_NEAR(found->stationary_part->begin_s, 1, 0.05);
  EXPECT_LE(found->stationary_part->end_s, kStationary_s + 0.1);
  const RecordingPart part = *found->stationary_part;
  const auto by_hand = estimate(window(whole, part.begin_s, part.end_s), {}, Job());
  ASSERT_TRUE(by_hand && by_hand->identifiable);
  EXPECT_EQ(by_hand->offset_s, found->offset_s);
  EXPECT_EQ(part_of_whole(later, part).scans.size(), window(whole, part.begin_s, part.end_s).scans.size());
}

// Three sweeps: no pair of them shows that the rig goes on within the last one.
TEST(StationaryPart, IsFoundWhereTheRigMovesWithinTheLastSweepAlone) {
  const auto moves = estimate(recorded(4, 10.5), {}, Job()), rests = estimate(recorded(4, 12), {}, Job());
  ASSERT_TRUE(moves && moves->identifiable && moves->stationary_part);
  EXPECT_NEAR(moves->stationary_part->end_s, 10.5, 0.6);
  EXPECT_NEAR(*moves->offset_s, kPartTruth_s, 0.3 * kMs);
  ASSERT_TRUE(rests && rests->identifiable);
  EXPECT_EQ(rests->kind, RigKind::kStationary);
  EXPECT_FALSE(rests->stationary_part);
}

TEST(StationaryPart, WithoutOneAShortWalkStaysRefused) {
  const auto found = estimate(recorded(0.7, 0), {}, Job());
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->identifiable);
  EXPECT_FALSE(found->stationary_part);
  EXPECT_EQ(found->refusals.at(0).kind, RefusalKind::kShortWalk);
}

TEST(StationaryPart, IsNotUsedWhereTheKindOfRigIsStated) {
  EstimateOptions options;
  options.assume = RigKind::kMoving;
  const auto found = estimate(recorded(0.7), options, Job());
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->identifiable);
  EXPECT_FALSE(found->stationary_part);
}

TEST(StationaryPart, IsNotUsedWhereTheWalkHasAnAnswer) {
  const Recording& recording = recorded(0.5, kStationary_s, 24);
  const auto found = estimate(recording, {}, Job());
  ASSERT_TRUE(found && found->identifiable);
  EXPECT_EQ(found->kind, RigKind::kMoving);
  EXPECT_FALSE(found->stationary_part);
}

// The robot is stationary for 13.0 s, in one whole sweep and two partial ones.
TEST(StationaryPart, OfTheRealTiltingScannerAnswersWithoutARigFile) {
  const std::filesystem::path data = test::real_data();
  if (data.empty()) GTEST_SKIP() << "no real recordings: set SWEEPSCOPE_REAL_DATA to their folder";
  const auto recording = read_fitting(data / "guardian_tilt/guardian_tilt_B.bag", {}, Job());
  ASSERT_TRUE(recording) << recording.error().message;
  const auto found = estimate(*recording, {}, Job());
  ASSERT_TRUE(found && found->identifiable);
  ASSERT_TRUE(found->stationary_part);
  EXPECT_EQ(found->stationary_part->begin_s, 0);
  EXPECT_NEAR(found->stationary_part->end_s, 13.0, 0.3);
  const auto by_hand = estimate(window(*recording, 0, 13), {}, Job());
  ASSERT_TRUE(by_hand && by_hand->identifiable);
  EXPECT_NEAR(*found->offset_s, *by_hand->offset_s, 1 * kMs);
  const auto later = estimate(window(*recording, 2, 17), {}, Job());
  ASSERT_TRUE(later && later->identifiable && later->stationary_part)
      << testing::PrintToString(later->reasons());
  EXPECT_NEAR(later->stationary_part->end_s, 13.0, 0.3);
  EXPECT_NEAR(*later->offset_s, *by_hand->offset_s, 1 * kMs);
}

}  // namespace
}  // namespace sweepscope
