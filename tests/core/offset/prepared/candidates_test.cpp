#include "core/offset/prepared/candidates.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cmath>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

std::vector<double> in_ms(const std::vector<OffsetRange>& ranges) {
  std::vector<double> offsets_ms;
  for (const double offset_s : offsets_of(ranges)) offsets_ms.push_back(offset_s * 1e3);
  return offsets_ms;
}

TEST(Candidates, ARangeHoldsBothItsEnds) {
  const std::vector<double> offsets_ms = in_ms({{19 * kMs, 29 * kMs, 1 * kMs}});
  ASSERT_EQ(offsets_ms.size(), 11u);
  for (int i = 0; i <= 10; ++i) EXPECT_NEAR(offsets_ms[std::size_t(i)], 19 + i, 1e-9);
}

TEST(Candidates, AnEndThatNoStepFallsOnIsNotReached) {
  EXPECT_EQ(in_ms({{0, 1 * kMs, 0.3 * kMs}}).size(), 4u);
}

// The paper's: 11 and 41 candidates, of which 22, 23, 24, 25 and 26 ms are in both.
TEST(Candidates, EachDistinctOffsetOfSeveralRangesIsThereOnceInAscendingOrder) {
  const std::vector<double> offsets_ms =
      in_ms({{22 * kMs, 26 * kMs, 0.1 * kMs}, {19 * kMs, 29 * kMs, 1 * kMs}});
  EXPECT_EQ(offsets_ms.size(), 47u);
  for (std::size_t i = 1; i < offsets_ms.size(); ++i) EXPECT_GT(offsets_ms[i] - offsets_ms[i - 1], 0.05);
}

TEST(Candidates, AroundIsHalfTheStepsToEitherSide) {
  const OffsetRange range = range_around({24 * kMs, 0.1 * kMs, 40});
  EXPECT_NEAR(range.from_s, 22 * kMs, 1e-12);
  EXPECT_NEAR(range.to_s, 26 * kMs, 1e-12);
  EXPECT_EQ(offsets_of({range}).size(), 41u);
}

TEST(Candidates, AnOddStepAroundFallsAboveTheInitialOffset) {
  const std::vector<double> offsets_ms = in_ms({range_around({24 * kMs, 1 * kMs, 3})});
  ASSERT_EQ(offsets_ms.size(), 4u);
  EXPECT_NEAR(offsets_ms.front(), 23, 1e-9);
  EXPECT_NEAR(offsets_ms.back(), 26, 1e-9);
}

// e of a curve of 11 candidates, 1 ms apart, from 19 ms on.
std::vector<CurvePoint> paper_curve_of(const std::function<std::optional<double>(double offset_ms)>& e_m) {
  std::vector<CurvePoint> curve;
  for (int i = 0; i <= 10; ++i) {
    curve.emplace_back().offset_s = (19 + i) * kMs;
    curve.back().e_m = e_m(19 + i);
  }
  return curve;
}

// A floor of 20 mm, and 10 mm more for each millisecond far from 23.8 ms.
std::optional<double> hyperbola_m(double offset_ms) {
  return std::hypot(0.02, 0.01 * (offset_ms - 23.8));
}

CriterionOptimum fitted(const std::vector<CurvePoint>& curve, double reach_s = 3 * kMs) {
  return fitted_extremum(curve, &CurvePoint::e_m, index_of_min(curve, &CurvePoint::e_m), reach_s);
}

TEST(FittedExtremum, OfADistanceIsExactOnAHyperbola) {
  const CriterionOptimum least = fitted(paper_curve_of(hyperbola_m));
  EXPECT_NEAR(least.offset_s, 23.8 * kMs, 1e-12);
  EXPECT_EQ(least.value, *hyperbola_m(24));  // the curve's own value, at the point nearest to it
}

TEST(FittedExtremum, OfMatchesIsExactOnAParabola) {
  std::vector<CurvePoint> curve = paper_curve_of(hyperbola_m);
  for (CurvePoint& point : curve) point.n = 30000 - 1e6 * *point.e_m * *point.e_m;
  const CriterionOptimum most =
      fitted_extremum(curve, &CurvePoint::n, index_of_max(curve, &CurvePoint::n), 3 * kMs);
  EXPECT_NEAR(most.offset_s, 23.8 * kMs, 1e-12);
  EXPECT_EQ(most.value, 30000 - 1e6 * *hyperbola_m(24) * *hyperbola_m(24));
}

TEST(FittedExtremum, OfFewerThanFivePointsIsTheGridPoint) {
  EXPECT_DOUBLE_EQ(fitted(paper_curve_of(hyperbola_m), 0.5 * kMs).offset_s, 24 * kMs);
}

TEST(FittedExtremum, WhereCandidatesAreSparseThoseFartherAwayCountToo) {
  EXPECT_NEAR(fitted(paper_curve_of(hyperbola_m), 1 * kMs).offset_s, 23.8 * kMs, 1e-12);
}

TEST(FittedExtremum, WhereTheyAreDenseThoseFartherAwayDoNotCount) {
  std::vector<CurvePoint> curve;
  for (int tenth = 190; tenth <= 290; ++tenth) {
    curve.emplace_back().offset_s = tenth * 1e-4;
    curve.back().e_m = std::abs(tenth - 238) <= 10 ? *hyperbola_m(tenth * 0.1) : 0.03 + 1e-4 * tenth;
  }
  EXPECT_NEAR(fitted(curve, 1 * kMs).offset_s, 23.8 * kMs, 1e-12);
}

TEST(FittedExtremum, PointsBeyondAFailedCandidateDoNotBelong) {
  const auto with_gap = [](double offset_ms) {
    return offset_ms == 26 ? std::nullopt : std::optional(offset_ms > 26 ? 9.0 : *hyperbola_m(offset_ms));
  };
  EXPECT_NEAR(fitted(paper_curve_of(with_gap)).offset_s, 23.8 * kMs, 1e-12);
  const auto with_two_gaps = [](double offset_ms) {
    return offset_ms == 22 || offset_ms == 26 ? std::nullopt : hyperbola_m(offset_ms);
  };
  EXPECT_DOUBLE_EQ(fitted(paper_curve_of(with_two_gaps)).offset_s, 24 * kMs);  // three are left
}

// The paper's own search: by 1 ms, and by 0.1 ms round the valley. The least candidate lies off its middle,
// so that 21 ms is within reach and 27 ms is not.
TEST(FittedExtremum, WhatOneSideHasMoreOfDoesNotPull) {
  std::vector<CurvePoint> curve;
  for (int tenth = 190; tenth <= 290; tenth += tenth < 220 || tenth >= 260 ? 10 : 1) {
    curve.emplace_back().offset_s = tenth * 1e-4;
    curve.back().e_m = 0.0121 + 1e-3 * std::abs(tenth - 240) - (tenth == 239 ? 0.0011 : 0);
  }
  EXPECT_NEAR(fitted(curve).offset_s, 24 * kMs, 0.02 * kMs);
}

TEST(FittedExtremum, AFitThatBendsTheWrongWayIsNotBelieved) {
  const auto spike = [](double offset_ms) {
    return offset_ms == 24 ? 0.9 : 1 - 0.001 * std::pow(offset_ms - 24, 2);
  };
  EXPECT_DOUBLE_EQ(fitted(paper_curve_of(spike)).offset_s, 24 * kMs);
}

TEST(FittedExtremum, StaysInsideItsPoints) {
  const CriterionOptimum least = fitted(paper_curve_of([](double offset_ms) { return 1 / offset_ms; }));
  EXPECT_LE(least.offset_s, 29 * kMs);
}

TEST(FitOfExtremum, GoesThroughPointsThatLieOnAHyperbola) {
  const std::vector<CurvePoint> curve = paper_curve_of(hyperbola_m);
  const auto fit = fit_of_extremum(curve, &CurvePoint::e_m, index_of_min(curve, &CurvePoint::e_m), 3 * kMs);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->from_s, 21 * kMs, 1e-12);
  EXPECT_NEAR(fit->to_s, 27 * kMs, 1e-12);
  for (const double offset_ms : {21.0, 23.8, 26.5})
    EXPECT_NEAR(fit->at(offset_ms * kMs), *hyperbola_m(offset_ms), 1e-12);
}

// Of a walk: by their squares alone, the points far from the tip would lift the curve to 21.6 mm.
TEST(FitOfExtremum, LiesNearTheTipWhereTheCurveFlattens) {
  std::vector<CurvePoint> curve;
  for (const double e_mm : {37.7, 29.6, 17.4, 27.2, 36.1}) {
    const double offset_ms = 22.0 + double(curve.size());
    curve.emplace_back().offset_s = offset_ms * kMs;
    curve.back().e_m = e_mm * 1e-3;
  }
  const auto fit = fit_of_extremum(curve, &CurvePoint::e_m, 2, 2 * kMs);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at(24 * kMs), 0.0174, 0.0025);
}

TEST(FitBehind, FindsTheReachThatGaveTheAnswer) {
  const auto curve =
      paper_curve_of([](double offset_ms) { return 0.02 + 1e-3 * std::pow(offset_ms - 23.7, 4); });
  for (const double reach_s : {2 * kMs, 3 * kMs, 4 * kMs}) {
    const auto fit = fit_behind(curve, &CurvePoint::e_m, fitted(curve, reach_s));
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->from_s, 24 * kMs - reach_s, 1e-9);
    EXPECT_NEAR(fit->to_s, 24 * kMs + reach_s, 1e-9);
  }
}

TEST(FitBehind, ThereIsNoneBehindAnAnswerFromElsewhere) {
  const auto curve = paper_curve_of(hyperbola_m);
  EXPECT_FALSE(fit_behind(curve, &CurvePoint::e_m, {"e", 24 * kMs, 0.02}));
  EXPECT_FALSE(fit_behind(curve, &CurvePoint::e_m, {"e", 23.5 * kMs, 0.02}));
  EXPECT_FALSE(fit_behind(curve, &CurvePoint::d, {"d", 23.8 * kMs, 0.02}));
}

TEST(Extremum, AFailedCandidateNeverWins) {
  const auto curve = paper_curve_of(
      [](double offset_ms) { return offset_ms == 24 ? std::nullopt : hyperbola_m(offset_ms); });
  EXPECT_DOUBLE_EQ(curve[index_of_min(curve, &CurvePoint::e_m)].offset_s, 23 * kMs);
  EXPECT_DOUBLE_EQ(curve[index_of_max(curve, &CurvePoint::e_m)].offset_s, 29 * kMs);
  const auto none = paper_curve_of([](double) { return std::nullopt; });
  EXPECT_EQ(index_of_min(none, &CurvePoint::e_m), none.size());
  EXPECT_EQ(index_of_max(none, &CurvePoint::e_m), none.size());
}

CurvePoint wavy(double offset_s, const Job&) {
  CurvePoint point;
  point.offset_s = offset_s;
  point.d = std::sin(1e3 * offset_s);
  return point;
}

const std::vector<double> kHundred = offsets_of({{0, 99 * kMs, kMs}});

TEST(Curve, IsTheSameForOneAndTwoThreads) {
  const auto computed = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Curve curve(wavy);
    EXPECT_TRUE(curve.compute(kHundred, Job()));
    std::vector<double> values;
    for (const CurvePoint& point : curve.points()) values.insert(values.end(), {point.offset_s, *point.d});
    return values;
  };
  EXPECT_EQ(computed(1), computed(2));
  EXPECT_EQ(computed(1).size(), 200u);
}

TEST(Curve, SkipsOffsetsThatItHasAlreadyAndStaysAscending) {
  std::atomic<int> calls{0};
  Curve curve([&](double offset_s, const Job& job) {
    ++calls;
    return wavy(offset_s, job);
  });
  curve.compute(offsets_of({{19 * kMs, 29 * kMs, 1 * kMs}}), Job());
  curve.compute(offsets_of({{22 * kMs, 26 * kMs, 0.1 * kMs}}), Job());
  EXPECT_EQ(calls, 47);
  ASSERT_EQ(curve.points().size(), 47u);
  for (std::size_t i = 1; i < 47; ++i) EXPECT_GT(curve.points()[i].offset_s, curve.points()[i - 1].offset_s);
}

TEST(Curve, KeepsWhatWasFinishedWhenCancelled) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  Job job;
  int calls = 0;
  Curve curve([&](double offset_s, const Job& part) {
    if (++calls == 10) job.cancel();
    return wavy(offset_s, part);
  });
  EXPECT_FALSE(curve.compute(kHundred, job));
  EXPECT_EQ(curve.points().size(), 9u);  // the tenth was cut short
  EXPECT_EQ(calls, 10);
}

TEST(Curve, ReportsHowFarItIs) {
  std::atomic<int> reports{0};
  const Job job([&](std::string_view, double fraction) {
    ++reports;
    EXPECT_GT(fraction, 0);
    EXPECT_LE(fraction, 1);
  });
  Curve curve(wavy);
  curve.compute(kHundred, job);
  EXPECT_EQ(reports, 100);
}

}  // namespace
}  // namespace sweepscope
