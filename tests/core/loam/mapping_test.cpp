#include "core/loam/mapping.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/loam/judged_walk.hpp"
#include "core/loam/relocalisation.hpp"
#include "core/offset/criteria/moving_candidate.hpp"
#include "core/offset/direct/direct_moving.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kMs;

// A rig that goes at 0.5 m/s from the first beam on, which the tracker begins to follow as if it stood.
class SteadyWalk : public testing::Test {
  static Recording record() {
    test::Bench bench;
    bench.mesh = test::hall();
    bench.duration_s = 8;
    bench.noise_m = 0.01;
    bench.world_from_base = [](double t_s) {
      return Eigen::Isometry3d(Eigen::Translation3d(-2 + 0.5 * t_s, 0.3, 0));
    };
    return bench.record();
  }
  struct Tracked {
    Recording recording = record();
    OffsetProblem problem = test::problem_of(recording);
    TrackedWalk walk = track(problem, 0, MappingOptions(), Job()).value();
  };
  static const Tracked& tracked() {
    static const Tracked once;
    return once;
  }

 protected:
  const Recording& recording_ = tracked().recording;
  const OffsetProblem& problem_ = tracked().problem;
  const TrackedWalk& walk_ = tracked().walk;
};

TEST_F(SteadyWalk, StepsComeOutEqual) {
  ASSERT_GE(walk_.sweeps.size(), 14u);
  EXPECT_EQ(walk_.tracked(), walk_.sweeps.size());
  EXPECT_TRUE(lost_intervals(walk_.sweeps).empty());
  for (std::size_t k = 3; k + 1 < walk_.sweeps.size(); ++k) {
    const SweepPose &before = walk_.sweeps[k - 1], &after = walk_.sweeps[k];
    const double lasted_s = (after.begin_s + after.end_s - before.begin_s - before.end_s) / 2;
    const Vector3d step_m = after.middle().translation_m - before.middle().translation_m;
    EXPECT_NEAR(step_m.x() / lasted_s, 0.5, 0.05) << k;
    EXPECT_NEAR(step_m.tail<2>().norm(), 0, 0.02) << k;
  }
}

// From the first beam to the last: the motor's first sweep began before, and its last one ends after.
TEST_F(SteadyWalk, TheWayIsAsLongAsItWas) {
  const double first_s = recording_.scans.front().first_beam_s,
               last_s = recording_.scans.back().last_beam_s();
  const auto at = [](const SweepPose& sweep, double time_s) {
    return sweep.at((time_s - sweep.begin_s) / (sweep.end_s - sweep.begin_s));
  };
  const Pose way = at(walk_.sweeps.front(), first_s).inverse() * at(walk_.sweeps.back(), last_s);
  EXPECT_NEAR((way.translation_m - Vector3d(0.5 * (last_s - first_s), 0, 0)).norm(), 0, 0.05);
}

TEST_F(SteadyWalk, WithinASweepTheRigMovesToo) {
  for (std::size_t k = 3; k + 1 < walk_.sweeps.size(); ++k) {
    const SweepPose& sweep = walk_.sweeps[k];
    const double moved_m = (sweep.end().translation_m - sweep.begin().translation_m).x();
    EXPECT_NEAR(moved_m / (sweep.end_s - sweep.begin_s), 0.5, 0.1) << k;
  }
}

TEST_F(SteadyWalk, IsTheSameFromSweepsThatArePlacedAlready) {
  const TrackedWalk same = track(place_sweeps(problem_, 0), MappingOptions(), Job()).value();
  ASSERT_EQ(same.sweeps.size(), walk_.sweeps.size());
  for (std::size_t k = 0; k < same.sweeps.size(); ++k)
    EXPECT_EQ(same.sweeps[k].end().translation_m, walk_.sweeps[k].end().translation_m) << k;
}

TEST_F(SteadyWalk, MayBeginAnywhere) {
  MappingOptions options;
  options.starts = {9};
  const TrackedWalk walk = track(problem_, 0, options, Job()).value();
  EXPECT_EQ(walk.starts, std::vector<std::size_t>{9});
  EXPECT_EQ(walk.tracked(), walk.sweeps.size());
  EXPECT_NEAR(walk.sweeps.front().begin().translation_m.norm(), 0, 1e-12);
  const Vector3d way_m = walk.sweeps.back().end().translation_m;
  EXPECT_NEAR(way_m.norm(), 0.5 * (walk.sweeps.back().end_s - walk.sweeps.front().begin_s), 0.05);
}

TEST_F(SteadyWalk, GoesOnFromSweepsWhosePosesAreKnown) {
  const Pose there{Eigen::Quaterniond(Eigen::AngleAxisd(1, Vector3d::UnitZ())), Vector3d(3, 4, 0)};
  KnownSweeps known{6, {walk_.sweeps.begin() + 6, walk_.sweeps.begin() + 10}};
  for (SweepPose& sweep : known.poses)
    for (Pose& knot : sweep.knots) knot = there * knot;
  const JudgedWalk walk = track_from(problem_, 0, known, MappingOptions(), Job()).value();
  ASSERT_EQ(walk.tracked(), walk_.sweeps.size());
  const Pose to_here = walk_.sweeps[6].begin() * walk.sweeps[6].begin().inverse();
  for (std::size_t k = 0; k < walk.sweeps.size(); ++k) {
    const Vector3d apart_m =
        to_here * walk.sweeps[k].end().translation_m - walk_.sweeps[k].end().translation_m;
    const bool is_known = k >= 6 && k < 10;
    EXPECT_LT(apart_m.norm(), 0.05) << k;
    EXPECT_EQ(apart_m.norm() < 1e-9, is_known) << k << ": the others are tracked on another map";
    EXPECT_TRUE(!is_known || walk.sweeps[k].matches == walk_.sweeps[k].matches) << k;
  }
}

// Of a recording that begins within a sweep.
TEST(Track, TwoTracksThatAgreeAreEnoughWhereTheFirstSweepIsLost) {
  const OffsetProblem problem = test::problem_of(test::simulated("metro-station", 0.024, 20).recording);
  std::vector<PlacedSweep> sweeps = place_sweeps(problem, 0.024);
  for (std::vector<PlacedFeature>* features : {&sweeps.front().edges, &sweeps.front().planes})
    for (PlacedFeature& feature : *features) feature.p_in_base_m += Vector3d(100, 0, 0);
  const TrackedWalk walk = track(sweeps, MappingOptions(), Job()).value();
  ASSERT_TRUE(walk.sweeps.front().lost);
  EXPECT_EQ(walk.tracked(), walk.sweeps.size() - 1);
  EXPECT_EQ(walk.starts.size(), 2u);
  EXPECT_TRUE(walk.well);
}

// A track of the same walk at a near offset, which found 2 m more within two seconds.
JudgedWalk longer(const TrackedWalk& tracked, bool confirmed) {
  JudgedWalk walk{tracked, {}, {}};
  constexpr double kMore_m = 2;
  constexpr std::size_t kFirst = 6, kSweeps = 4;
  for (std::size_t k = kFirst; k < walk.sweeps.size(); ++k) {
    std::vector<Pose>& knots = walk.sweeps[k].knots;
    for (std::size_t i = 0; i < knots.size(); ++i) {
      const double after = double(k - kFirst) + double(i) / double(knots.size() - 1);
      knots[i].translation_m.x() += kMore_m * std::min(1.0, after / kSweeps);
    }
  }
  walk.agreed.assign(walk.sweeps.size(), confirmed ? 1 : 0);
  return walk;
}

TEST_F(SteadyWalk, ATrackOfANearOffsetThatFoundAnotherMotionIsAContradiction) {
  for (const bool confirmed : {false, true}) {
    MappingOptions options;
    const JudgedWalk earlier = longer(walk_, confirmed);
    options.starts = {walk_.starts.front()};
    const JudgedWalk walk = track_and_judge(problem_, 0, options, &earlier, Job()).value();
    ASSERT_EQ(walk.contradictions.size(), 1u);
    EXPECT_NEAR(walk.contradictions.front().apart.shift_m, 2, 0.1);
    // The confirmed motion is taken.
    EXPECT_NEAR((walk.sweeps.back().end().translation_m - walk_.sweeps.back().end().translation_m).norm(),
                confirmed ? 2 : 0, 0.1);
  }
}

// Sweeps of another place in the middle: what comes before them does not fit what comes after.
TEST_F(SteadyWalk, WhereTheMapDoesNotFitTheRigIsLostAndBeginsAnew) {
  std::vector<PlacedSweep> sweeps = place_sweeps(problem_, 0), twice;
  for (const double shift_s : {0.0, 100.0})
    for (PlacedSweep sweep : sweeps) {
      sweep.begin_s += shift_s;
      sweep.end_s += shift_s;
      // Upside down, so that nothing of the first map matches.
      if (shift_s > 0)
        for (auto* features : {&sweep.edges, &sweep.planes})
          for (PlacedFeature& feature : *features)
            feature.p_in_base_m = Vector3d(2.5, 7, 3) + 0.4 * feature.p_in_base_m.reverse();
      twice.push_back(sweep);
    }
  const TrackedWalk walk = track(twice, MappingOptions(), Job()).value();
  ASSERT_EQ(walk.sweeps.size(), 2 * sweeps.size());
  EXPECT_NE(walk.sweeps.front().stretch, walk.sweeps.back().stretch);
  EXPECT_GT(walk.tracked(), walk.sweeps.size() - 8);
  for (std::size_t k = 1; k < walk.sweeps.size(); ++k)
    EXPECT_LT((walk.sweeps[k].begin().translation_m - walk.sweeps[k - 1].end().translation_m).norm(), 0.3)
        << k;
}

// The rig is carried on unseen and turned; what it sees then is the same hall.
TEST_F(SteadyWalk, AfterAGapTheRigIsFoundOnItsMap) {
  const Pose turned{rotation_from_vector({0.05, -0.1, 2.1}), Vector3d(0.4, -0.3, 0.1)};
  std::vector<PlacedSweep> sweeps = place_sweeps(problem_, 0);
  const std::size_t half = sweeps.size() / 2;
  for (std::size_t k = half; k < sweeps.size(); ++k) {
    sweeps[k].begin_s += 3;
    sweeps[k].end_s += 3;
    sweeps[k].turned_rad = turned.rotation * sweeps[k].turned_rad;
    for (auto* features : {&sweeps[k].edges, &sweeps[k].planes})
      for (PlacedFeature& feature : *features) feature.p_in_base_m = turned * feature.p_in_base_m;
  }
  const TrackedWalk tracked = track(sweeps, MappingOptions(), Job()).value();
  EXPECT_NE(tracked.sweeps.front().stretch, tracked.sweeps.back().stretch);
  const std::vector<SweepPose> walk = relocalised(
      tracked.sweeps, [&](std::size_t i) { return sweeps[i]; }, MappingOptions(), Job());
  EXPECT_EQ(walk.front().stretch, walk.back().stretch);
  const auto way = [](const Pose& from, const Pose& to) { return from.inverse() * to; };
  const std::size_t last = sweeps.size() - 2;  // the last sweep is not whole
  const Pose found = way(walk[2].middle(), walk[last].middle()),
             truth = way(walk_.sweeps[2].middle(), walk_.sweeps[last].middle() * turned.inverse());
  EXPECT_NEAR((found.translation_m - truth.translation_m).norm(), 0, 0.05);
  EXPECT_NEAR(turn_between(truth.rotation, found.rotation).norm(), 0, 1 * test::kDegree);
}

// Points without any surface.
TEST_F(SteadyWalk, WhatFitsNowhereStaysAPieceOfItsOwn) {
  std::vector<PlacedSweep> sweeps = place_sweeps(problem_, 0);
  std::vector<SweepPose> poses = walk_.sweeps;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-10, 10);
  for (std::size_t k = sweeps.size() / 2; k < sweeps.size(); ++k) {
    poses[k].stretch = 2;
    for (auto* features : {&sweeps[k].edges, &sweeps[k].planes})
      for (PlacedFeature& feature : *features)
        feature.p_in_base_m = Vector3d(within(random), within(random), within(random));
  }
  const std::vector<SweepPose> pieces = relocalised(
      poses, [&](std::size_t i) { return sweeps[i]; }, MappingOptions(), Job());
  EXPECT_EQ(pieces.front().stretch, 1U);
  EXPECT_EQ(pieces.back().stretch, 2U);
}

TEST(PiecesWarning, NamesWhereStretchesBeginThatDoNotFit) {
  Recording recording;
  recording.scans.resize(1);
  recording.scans[0].first_beam_s = 1;
  std::vector<SweepPose> sweeps(9);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    sweeps[k].begin_s = 1 + double(k);
    sweeps[k].stretch = k < 4 ? 1 : 0;
  }
  EXPECT_FALSE(pieces_warning(sweeps, recording));
  sweeps[6].stretch = sweeps[7].stretch = 2;
  sweeps[8].stretch = 1;
  const auto warning = pieces_warning(sweeps, recording);
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("2 pieces"), std::string::npos) << *warning;
  EXPECT_NE(warning->find("from 6.0 s on"), std::string::npos) << *warning;
}

// The sweep that a recording begins with may end before its first scan.
TEST(LostTimes, LeaveOutSweepsWithoutScans) {
  Recording recording;
  recording.scans.resize(2);
  recording.scans[0].first_beam_s = 1;
  recording.scans[1].first_beam_s = 4;
  for (LaserScan& scan : recording.scans) scan.beams = 1;
  std::vector<SweepPose> sweeps(4);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    sweeps[k].begin_s = double(k);
    sweeps[k].end_s = double(k + 1);
    sweeps[k].lost = k == 0;
  }
  EXPECT_TRUE(lost_times(sweeps, recording).empty());
  EXPECT_FALSE(lost_warning(lost_times(sweeps, recording)));
  SolvedWalk walk;
  walk.sweeps = sweeps;
  EXPECT_EQ(lost_refusal(walk, recording).text.find("0.0 s"), std::string::npos);
  sweeps[2].lost = true;
  ASSERT_EQ(lost_times(sweeps, recording).size(), 1U);
  EXPECT_EQ(lost_times(sweeps, recording)[0].begin_s, 1);
}

TEST(LostIntervals, AreRunsOfLostSweeps) {
  std::vector<SweepPose> sweeps(7);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    sweeps[k].begin_s = double(k);
    sweeps[k].end_s = double(k + 1);
    sweeps[k].lost = k == 0 || k == 3 || k == 4;
  }
  const std::vector<Interval> lost = lost_intervals(sweeps);
  ASSERT_EQ(lost.size(), 2u);
  EXPECT_EQ(lost[0].begin_s, 0);
  EXPECT_EQ(lost[0].end_s, 1);
  EXPECT_EQ(lost[1].begin_s, 3);
  EXPECT_EQ(lost[1].end_s, 5);
}

// A minute through the metro station at a true offset of 24 ms.
class Walk : public testing::Test {
 protected:
  struct Tracked {
    OffsetProblem problem = test::problem_of(test::simulated("metro-station", 0.024, 60).recording);
    TrackedWalk walk = track(problem, 0.024, MappingOptions(), Job()).value();
  };
  static const Tracked& tracked() {
    static const Tracked once;
    return once;
  }
  CurvePoint candidate(double off_s) const {
    return moving_candidate(problem_, 0.024 + off_s, tracked().walk.sweeps, MappingOptions(), Job());
  }
  const OffsetProblem& problem_ = tracked().problem;
};

TEST_F(Walk, ARollThatAlternatesTellsHowFarTheOffsetIsOff) {
  const CurvePoint below = candidate(-kMs), above = candidate(kMs);
  const double slope = (*above.signed_rotation_rad - *below.signed_rotation_rad) / (2 * kMs);
  EXPECT_NEAR(slope / (2 * problem_.motor.median_speed_rad_s), 1, 0.15);
  EXPECT_NEAR(*candidate(0).signed_rotation_rad / slope, 0, 0.1 * kMs);
}

TEST_F(Walk, FiveMillisecondsOffTheMeanDistanceIsClearlyLarger) {
  const CurvePoint truth = candidate(0), off = candidate(5 * kMs);
  EXPECT_GT(*off.e_m, 1.3 * *truth.e_m);
  EXPECT_LT(*off.n, *truth.n);
}

TEST_F(Walk, CountingStopsAtTheSweepAtWhichItIsCancelled) {
  const MatchCount all = count_matches(problem_, 0.024, tracked().walk.sweeps, MappingOptions(), Job());
  LookCount half(tracked().walk.sweeps.size() / 2);
  Job job;
  job.obey(half);
  const MatchCount some = count_matches(problem_, 0.024, tracked().walk.sweeps, MappingOptions(), job);
  EXPECT_GT(some.matches, 0u);
  EXPECT_LT(some.matches, all.matches * 2 / 3);
}

TEST(Track, ACancelledJobIsInterrupted) {
  Job job;
  job.cancel();
  const auto result = track(std::vector<PlacedSweep>(2), MappingOptions(), job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::kInterrupted);
}

// Ground with posts: many where the walk begins, few where it ends. There the ground looks the same at any
// speed, and the rig as if it stood.
TEST(FieldWalk, BeginsWhereTheMotionCanBeSeen) {
  test::Bench bench;
  bench.mesh = simulation::box({-40, -40, -1.6}, {60, 40, -1.5});
  for (double x_m = -6; x_m < 12; x_m += 2.5) {
    bench.mesh.add_box({x_m, 2.5, -1.5}, {x_m + 0.3, 2.8, 2});
    bench.mesh.add_box({x_m + 1.2, -3.3, -1.5}, {x_m + 1.5, -3, 2});
  }
  for (double x_m = 14; x_m < 40; x_m += 5)
    bench.mesh.add_box({x_m, 4, -1.5}, {x_m + 0.4, 4.4, 2})
        .add_box({x_m + 2, -5, -1.5}, {x_m + 2.4, -4.6, 2});
  bench.duration_s = 16;
  bench.noise_m = 0.01;
  bench.world_from_base = [](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(1.3 * t_s, 0.02 * std::sin(6 * t_s), 0));
  };
  const Recording recording = bench.record();
  const OffsetProblem problem = test::problem_of(recording);
  const auto way_m = [](const TrackedWalk& walk) {
    return (walk.sweeps.front().begin().inverse() * walk.sweeps.back().end()).translation_m.norm();
  };
  const TrackedWalk walk = track(problem, 0, MappingOptions(), Job()).value();
  const double truth_m = 1.3 * (walk.sweeps.back().end_s - walk.sweeps.front().begin_s);
  EXPECT_LT(walk.starts.front(), walk.sweeps.size() / 2);
  EXPECT_NEAR(way_m(walk), truth_m, 1);
  MappingOptions calm;
  calm.well_determined = 0;
  calm.max_starts = 1;
  const TrackedWalk misled = track(problem, 0, calm, Job()).value();
  EXPECT_GT(misled.starts.front(), walk.sweeps.size() / 2);
  EXPECT_GT(std::abs(way_m(misled) - truth_m), 3);
}

}  // namespace
}  // namespace sweepscope
