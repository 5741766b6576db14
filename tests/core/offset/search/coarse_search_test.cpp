#include "core/offset/search/coarse_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

// As if nothing had moved, and yet the valley is where it belongs.
class CoarseSearchIn : public testing::TestWithParam<const char*> {};

TEST_P(CoarseSearchIn, FindsTheRightMillisecondFromAnywhere) {
  for (const double truth_s : {-0.047, 0.024}) {
    const Recording& recording = test::simulated(GetParam(), truth_s, 8).recording;
    const OffsetProblem problem = test::problem_of(recording);
    const CoarseSearch found =
        search_coarsely(problem, -60 * kMs, 60 * kMs, search_scale(problem.motor), Job());
    ASSERT_TRUE(found.best);
    EXPECT_NEAR(found.offset_s(), truth_s, 1.5 * kMs);
    EXPECT_NEAR(found.curve.front().offset_s, -60 * kMs, 1e-12);
    EXPECT_NEAR(found.curve.back().offset_s, 60 * kMs, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(StandingAndWalking, CoarseSearchIn,
                         testing::Values("room-2", "metro-station", "cemetery"));

CoarseSearch searched(double from_s, double to_s, const Job& job) {
  const OffsetProblem problem = test::problem_of(test::room(0.024));
  return search_coarsely(problem, from_s, to_s, search_scale(problem.motor), job);
}

TEST(CoarseSearch, ComputesEverySecondUnitAndThoseBesideTheBest) {
  const CoarseSearch found = searched(0, 60 * kMs, Job());
  ASSERT_TRUE(found.best);
  std::vector<double> offsets_ms;
  for (const CurvePoint& point : found.curve) {
    offsets_ms.push_back(point.offset_s / kMs);
    EXPECT_TRUE(point.capped_cost_m) << point.offset_s;
  }
  EXPECT_TRUE(std::is_sorted(offsets_ms.begin(), offsets_ms.end()));
  EXPECT_EQ(offsets_ms.size(), 31U + 2U);
  EXPECT_NEAR(found.offset_s(), 24 * kMs, 1e-9);
  for (const double beside_ms : {23.0, 25.0})
    EXPECT_TRUE(std::any_of(offsets_ms.begin(), offsets_ms.end(), [&](double ms) {
      return std::abs(ms - beside_ms) < 1e-6;
    })) << beside_ms;
}

SearchedWindow searched_by_default(double truth_s) {
  const auto prepared = prepare(test::room(truth_s), FeatureOptions(), Job());
  return search_by_default(*prepared, search_scale(prepared->motor), Job());
}

TEST(CoarseSearch, ByDefaultTheWindowIsAbout0WhereTheOffsetIsThere) {
  const SearchedWindow found = searched_by_default(0.024);
  EXPECT_NEAR(found.from_s, -60 * kMs, 1e-9);
  EXPECT_NEAR(found.to_s, 60 * kMs, 1e-9);
  EXPECT_EQ(found.coarse.curve.size(), 61U + 2U);
}

TEST(CoarseSearch, ByDefaultAnOffsetFarFrom0IsFoundToo) {
  for (const double truth_s : {0.061, 0.12, -0.2}) {
    const SearchedWindow found = searched_by_default(truth_s);
    ASSERT_TRUE(found.coarse.best) << truth_s;
    EXPECT_NEAR(found.coarse.offset_s(), truth_s, 1.5 * kMs);
    EXPECT_LT(found.from_s, truth_s - 40 * kMs);
    EXPECT_GT(found.to_s, truth_s + 40 * kMs);
  }
}

// Half of the motor's period is 0.5 s: an even motor shows a mirror image 0.5 s from the truth.
TEST(CoarseSearch, ByDefaultAMotorThatRestsShowsWhichOfTheImagesIsRight) {
  struct Rest {
    double at_s, s;
  };
  for (const auto& [at_s, rest_s] : {Rest{0, 1.5}, Rest{2, 1.2}, Rest{4.5, 2}})
    for (const double truth_s : {0.024, 0.35, -0.48}) {
      SimulationOptions options;
      options.scene = "room-2";
      options.offset_s = truth_s;
      options.duration_s = 6.5;
      options.motor_rest_at_s = at_s;
      options.motor_rest_s = rest_s;
      const Simulation simulation = simulate(options, Job()).value();
      const auto prepared = prepare(simulation.recording, FeatureOptions(), Job());
      const SearchedWindow found = search_by_default(*prepared, search_scale(prepared->motor), Job());
      ASSERT_TRUE(found.coarse.best) << truth_s;
      EXPECT_NEAR(found.coarse.offset_s(), truth_s, 2 * kMs) << at_s;
    }
}

TEST(CoarseSearch, SaysEachCandidateOnceWhenItIsFinished) {
  const OffsetProblem problem = test::problem_of(test::room(0.024));
  std::mutex mutex;
  std::vector<double> said_s;
  SearchWatch watch;
  watch.finished = [&](const CurvePoint& point) {
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(point.capped_cost_m);
    said_s.push_back(point.offset_s);
  };
  const CoarseSearch found = search_coarsely(problem, 0, 60 * kMs, search_scale(problem.motor), Job(), watch);
  std::sort(said_s.begin(), said_s.end());
  ASSERT_EQ(said_s.size(), found.curve.size());
  for (std::size_t i = 0; i < said_s.size(); ++i) EXPECT_EQ(said_s[i], found.curve[i].offset_s);
}

// Candidates of two searches in one chart would be a sawtooth: their costs have other levels.
TEST(CoarseSearch, SaysWhereASearchBeginsOfWhichTheCostsDoNotCompareWithThoseBefore) {
  for (const auto& [truth_s, min_searches] : {std::pair{0.024, 1}, std::pair{0.12, 2}}) {
    const auto prepared = prepare(test::room(truth_s), FeatureOptions(), Job());
    std::mutex mutex;
    std::vector<std::set<double>> searches;
    SearchWatch watch;
    watch.began = [&] {
      const std::lock_guard lock(mutex);
      searches.emplace_back();
    };
    watch.finished = [&](const CurvePoint& point) {
      const std::lock_guard lock(mutex);
      ASSERT_FALSE(searches.empty());
      EXPECT_TRUE(searches.back().insert(point.offset_s).second) << "twice in one search";
    };
    const SearchedWindow found = search_by_default(*prepared, search_scale(prepared->motor), Job(), watch);
    EXPECT_GE(searches.size(), std::size_t(min_searches));
    std::set<double> answered_s;
    for (const CurvePoint& point : found.coarse.curve)
      if (point.capped_cost_m) answered_s.insert(point.offset_s);
    EXPECT_EQ(searches.back(), answered_s);
  }
}

TEST(CoarseSearch, ACancelledOneHasNoBest) {
  Job job;
  job.cancel();
  const CoarseSearch found = searched(0, 60 * kMs, job);
  EXPECT_FALSE(found.best);
  EXPECT_EQ(found.offset_or(5 * kMs), 5 * kMs);
}

}  // namespace
}  // namespace sweepscope
