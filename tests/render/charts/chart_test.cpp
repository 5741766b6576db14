#include "render/charts/chart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/offset/prepared/candidates.hpp"
#include "render/charts/chart_layout.hpp"
#include "render/charts/curve_charts.hpp"
#include "render/charts/over_time_chart.hpp"
#include "render/pictures/picture.hpp"
#include "tests/render/synthetic_maps.hpp"

namespace sweepscope {
namespace {

constexpr double kChartMs = 1e-3;

bool overlap(const PixelRect& a, const PixelRect& b) {
  constexpr double kTouching = 1e-6;
  return a.left + kTouching < b.right() && b.left + kTouching < a.right() && a.top + kTouching < b.bottom() &&
         b.top + kTouching < a.bottom();
}

bool holds(const PixelRect& outer, const PixelRect& inner) {
  constexpr double kTouching = 1e-6;
  return inner.left >= outer.left - kTouching && inner.right() <= outer.right() + kTouching &&
         inner.top >= outer.top - kTouching && inner.bottom() <= outer.bottom() + kTouching;
}

ChartSeries series_named(const std::string& name) {
  return {name, {19, 24, 29}, {0.0123, std::nullopt, -0.0456}, {1, 2, 3}};
}

/// More names and labels than fit in one row.
Chart crowded_chart() {
  Chart chart;
  chart.title = "Mean distance per match e [mm]";
  chart.x_title = "offset [ms]";
  chart.absent_name = "failed";
  for (int i = 1; i <= 6; ++i) chart.series.push_back(series_named("recording-" + std::to_string(i)));
  for (const double x : {23.9, 24.0, 24.05, 24.1}) chart.verticals.push_back({x, "found 24.00 ± 0.06", {}});
  return chart;
}

std::vector<PixelRect> places_of(const ChartLayout& layout) {
  std::vector<PixelRect> places{layout.title_place, layout.plot};
  for (const LegendEntry& entry : layout.legend) places.push_back(entry.place);
  for (const VerticalLabel& label : layout.labels) places.push_back(label.place);
  return places;
}

TEST(ChartLayout, NothingOverlapsOrLeavesItsPlaceHoweverCrowded) {
  const Chart chart = crowded_chart();
  for (const auto& [width, height] : {std::pair{900.0, 600.0}, {400.0, 300.0}, {280.0, 320.0}}) {
    const PixelRect place{10, 20, width, height};
    const auto places = places_of(lay_out_chart(chart, place, 1));
    ASSERT_EQ(places.size(), 2 + 7 + 4U);  // six names, what failed, and four labels
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_TRUE(holds(place, places[i])) << width << ": " << i;
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_FALSE(overlap(places[i], places[k])) << width << ": " << i << " and " << k;
    }
  }
}

TEST(ChartLayout, ALegendThatFitsStandsBesideTheTitle) {
  Chart chart;
  chart.title = "d [m]";
  chart.series = {series_named("one"), series_named("two")};
  const ChartLayout wide = lay_out_chart(chart, {0, 0, 500, 300}, 1),
                    narrow = lay_out_chart(chart, {0, 0, 150, 300}, 1);
  EXPECT_EQ(wide.legend[0].place.top, wide.title_place.top);
  EXPECT_GT(narrow.legend[0].place.top, narrow.title_place.top);
  EXPECT_GT(narrow.plot.top, wide.plot.top);
}

TEST(ChartLayout, ASingleSeriesNeedsNoLegend) {
  Chart chart;
  chart.series = {series_named("one")};
  EXPECT_TRUE(lay_out_chart(chart, {0, 0, 500, 300}, 1).legend.empty());
  chart.absent_name = "failed";
  EXPECT_EQ(lay_out_chart(chart, {0, 0, 500, 300}, 1).legend.size(), 2U);
}

TEST(ChartLayout, TickLabelsDoNotTouchEachOther) {
  Chart chart;
  chart.series = {{"", {-0.00021, 0.00034}, {1, 2}, {}}};
  for (const double width : {150.0, 300.0, 900.0}) {
    const ChartLayout layout = lay_out_chart(chart, {0, 0, width, 300}, 1);
    ASSERT_GE(layout.x_ticks.values.size(), 1U);
    for (std::size_t i = 1; i < layout.x_ticks.values.size(); ++i) {
      const auto half = [&](std::size_t k) { return text_width_px(layout.x_ticks.labels[k], 13) / 2; };
      EXPECT_LT(layout.x_px(layout.x_ticks.values[i - 1]) + half(i - 1),
                layout.x_px(layout.x_ticks.values[i]) - half(i));
    }
  }
}

TEST(ChartLayout, APartOfTheAxisIsShownExactlyAndTheOtherAxisFitsWhatIsSeen) {
  Chart chart;
  chart.series.push_back({"e", {0, 10, 20, 30}, {100, 4, 6, 100}, {1, 2, 3}});
  for (const double x : {5.0, 15.0}) chart.verticals.push_back({x, "label", {}});
  chart.x_range = AxisRange{8, 21};
  const ChartLayout layout = lay_out_chart(chart, {0, 0, 500, 300}, 1);
  EXPECT_EQ(layout.x.from, 8);
  EXPECT_EQ(layout.x.to, 21);
  EXPECT_LT(layout.y.to, 30) << "the ends are cut off";
  EXPECT_GT(layout.y.to, 15.4) << "but the curve as far as it is shown is not";
  ASSERT_EQ(layout.labels.size(), 1u);
  Drawing drawing;
  add_chart(drawing, {0, 0, 500, 300}, chart, kDarkStyle, 1);
  for (const auto& mark : drawing.marks()) {
    const auto* line = std::get_if<LineMark>(&mark);
    if (line == nullptr || !(line->colour == Colour{1, 2, 3})) continue;
    for (const PixelPoint& point : line->points) {
      EXPECT_GE(point.x, layout.plot.left - 1e-6);
      EXPECT_LE(point.x, layout.plot.right() + 1e-6);
    }
  }
}

TEST(ChartLayout, WithoutValuesYHasNoNumbersAndThePlotTheSamePlace) {
  Chart chart;
  for (const double x : {-60.0, 60.0}) chart.verticals.push_back({x, "", {}});
  const ChartLayout empty = lay_out_chart(chart, {0, 0, 500, 300}, 1);
  EXPECT_TRUE(empty.y_ticks.values.empty());
  EXPECT_FALSE(empty.x_ticks.values.empty());
  chart.series.push_back({"c", {-60, 60}, {100, 300}, {1, 2, 3}});
  const ChartLayout full = lay_out_chart(chart, {0, 0, 500, 300}, 1);
  EXPECT_FALSE(full.y_ticks.values.empty());
  EXPECT_NEAR(full.plot.left, empty.plot.left, 1e-6);
}

TEST(Chart, IsReadAtTheShownPointNearestToAnX) {
  Chart chart;
  chart.series.push_back({"d", {0, 10, 20}, {3, std::nullopt, 5}, {1, 2, 3}});
  chart.series.push_back({"θ", {0, 10, 20}, {7, 8, 9}, {1, 2, 3}, MarkerShape::kSquare});
  chart.series.push_back({"fit", {0, 20}, {1, 1}, {1, 2, 3}, MarkerShape::kNone, true});
  const auto readings = read_chart(chart, 11);
  ASSERT_EQ(readings.size(), 2u);
  EXPECT_EQ(readings[0].x, 20) << "10 has no d";
  EXPECT_EQ(readings[1].y, 9);
  chart.x_range = AxisRange{-1, 12};
  EXPECT_EQ(read_chart(chart, 11)[0].y, 3);
  EXPECT_TRUE(read_chart(Chart(), 1).empty());
}

TEST(ChartLayout, AFilledSeriesStandsOnZero) {
  Chart chart;
  chart.series = {{"", {1, 2}, {5, 6}, {}}};
  EXPECT_GT(lay_out_chart(chart, {0, 0, 400, 300}, 1).y.from, 4);
  chart.series[0].filled = true;
  EXPECT_EQ(lay_out_chart(chart, {0, 0, 400, 300}, 1).y.from, 0);
}

template <typename Mark>
std::vector<Mark> marks_of(const Chart& chart) {
  Drawing drawing;
  add_chart(drawing, {0, 0, 600, 400}, chart, kDarkStyle, 1);
  std::vector<Mark> found;
  for (const Drawing::Mark& mark : drawing.marks()) {
    if (const Mark* one = std::get_if<Mark>(&mark)) found.push_back(*one);
  }
  return found;
}

bool has_text(const Chart& chart, const std::string& text) {
  const auto texts = marks_of<TextMark>(chart);
  return std::any_of(texts.begin(), texts.end(), [&](const TextMark& mark) { return mark.text == text; });
}

TEST(Chart, AnAbsentValueIsATickOnTheAxis) {
  Chart chart;
  chart.series = {series_named("one")};
  const ChartLayout layout = lay_out_chart(chart, {0, 0, 600, 400}, 1);
  int ticks = 0;
  for (const LineMark& line : marks_of<LineMark>(chart)) {
    ticks += line.colour == chart.series[0].colour && line.points[0].x == layout.x_px(24) &&
             line.points[1].y == layout.plot.bottom();
  }
  EXPECT_EQ(ticks, 1);
  for (const LineMark& line : marks_of<LineMark>(chart))  // and no line leads across the gap
    EXPECT_FALSE(line.colour == chart.series[0].colour && line.points.size() > 2);
}

TEST(Chart, SeriesOfTheSameColourDifferInTheirShapes) {
  const auto corners = [](MarkerShape shape) {
    Chart chart;
    chart.series = {{"", {1}, {1}, {9, 9, 9}, shape}};
    std::vector<std::size_t> counts;
    for (const PolygonMark& mark : marks_of<PolygonMark>(chart)) {
      if (mark.colour == Colour{9, 9, 9}) counts.push_back(mark.points.size());
    }
    return counts;
  };
  EXPECT_EQ(corners(MarkerShape::kNone), std::vector<std::size_t>());
  EXPECT_EQ(corners(MarkerShape::kCircle), std::vector<std::size_t>{24});
  EXPECT_EQ(corners(MarkerShape::kSquare), std::vector<std::size_t>{4});
  EXPECT_EQ(corners(MarkerShape::kTriangle), std::vector<std::size_t>{3});
}

TEST(Chart, ASpanHasItsLabelBesideTheCurve) {
  Chart chart;
  ChartSeries density{"", {}, {}, {9, 9, 9}, MarkerShape::kNone};
  density.filled = true;
  for (int i = -50; i <= 50; ++i) {
    density.x.push_back(i);
    density.y.push_back(std::exp(-i * i / 200.0));
  }
  chart.series = {density};
  chart.spans = {{0.5, -11.8, 11.8, "24 mm", {7, 7, 7}}};
  const ChartLayout layout = lay_out_chart(chart, {0, 0, 600, 400}, 1);
  EXPECT_EQ(marks_of<AreaMark>(chart).size(), 1U);
  ASSERT_TRUE(has_text(chart, "24 mm"));
  for (const TextMark& mark : marks_of<TextMark>(chart)) {
    if (mark.text != "24 mm") continue;
    const double half_width = text_width_px(mark.text, mark.size_px, true) / 2;
    const double nearest_mm =
        (std::abs(mark.at.x - layout.x_px(0)) - half_width) / (layout.x_px(1) - layout.x_px(0));
    EXPECT_GT(nearest_mm, 11.8);
  }
}

TEST(Chart, AnUncertaintyBandIsShadedAndStaysInThePlot) {
  Chart chart;
  chart.series = {{"", {19, 29}, {1, 2}, {}}};
  chart.bands = {{23.5, 24.5, {7, 7, 7}}, {-100, 20, {8, 8, 8}}};
  const ChartLayout layout = lay_out_chart(chart, {0, 0, 600, 400}, 1);
  std::vector<PolygonMark> bands;
  for (const PolygonMark& mark : marks_of<PolygonMark>(chart)) {
    if (mark.colour.alpha == 56) bands.push_back(mark);
  }
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_NEAR(bands[0].points[0].x, layout.x_px(23.5), 1e-9);
  EXPECT_NEAR(bands[0].points[1].x, layout.x_px(24.5), 1e-9);
  EXPECT_EQ(bands[1].points[0].x, layout.plot.left);
}

/// e of a walk whose least value lies between two candidates.
Estimate walk(double min_ms, std::optional<double> sigma_s) {
  Estimate estimate;
  estimate.identifiable = true;
  for (int ms = 19; ms <= 29; ++ms) {
    estimate.curve.emplace_back().offset_s = ms * kChartMs;
    estimate.curve.back().e_m = std::hypot(0.02, 0.01 * (ms - min_ms)) + 1e-5 * (ms % 3);
  }
  CriterionOptimum optimum = fitted_extremum(estimate.curve, &CurvePoint::e_m,
                                             index_of_min(estimate.curve, &CurvePoint::e_m), 1 * kChartMs);
  optimum.name = "e";
  estimate.criteria = {optimum};
  estimate.offset_s = optimum.offset_s;
  estimate.sigma_s = sigma_s;
  return estimate;
}

TEST(CurveCharts, ShowTheFitThatGaveTheAnswer) {
  const Estimate estimate = walk(23.8, std::nullopt);
  const auto charts = curve_charts(estimate, {}, kDarkStyle);
  ASSERT_EQ(charts.size(), 1U);
  ASSERT_EQ(charts[0].series.size(), 2U);
  const ChartSeries& fit = charts[0].series[1];
  EXPECT_EQ(fit.name, "fit");
  EXPECT_TRUE(fit.dashed);
  EXPECT_NEAR(fit.x.front(), 22, 1e-9);  // two steps to either side of 24
  EXPECT_NEAR(fit.x.back(), 26, 1e-9);
  const auto least = std::min_element(fit.y.begin(), fit.y.end());
  const double step_ms = fit.x[1] - fit.x[0];
  EXPECT_NEAR(fit.x[std::size_t(least - fit.y.begin())], *estimate.offset_s * 1e3, step_ms);
}

TEST(CurveCharts, AGridPointHasNoFit) {
  Estimate estimate = walk(23.8, std::nullopt);
  estimate.criteria[0].offset_s = 24 * kChartMs;  // as with no fit
  EXPECT_EQ(curve_charts(estimate, {}, kDarkStyle)[0].series.size(), 1U);
}

TEST(CurveCharts, HaveABandOnlyWithAnUncertainty) {
  EXPECT_TRUE(curve_charts(walk(23.8, std::nullopt), {}, kDarkStyle)[0].bands.empty());
  const Estimate estimate = walk(23.8, 0.2 * kChartMs);
  const Chart chart = curve_charts(estimate, {}, kDarkStyle)[0];
  ASSERT_EQ(chart.bands.size(), 1U);
  EXPECT_NEAR(chart.bands[0].from, *estimate.offset_s * 1e3 - 0.2, 1e-9);
  EXPECT_NEAR(chart.bands[0].to, *estimate.offset_s * 1e3 + 0.2, 1e-9);
  Estimate refused = estimate;
  refused.identifiable = false;
  EXPECT_TRUE(curve_charts(refused, {}, kDarkStyle)[0].bands.empty());
}

TEST(CurvesOfMany, AreASeriesEachWithItsOwnLook) {
  std::vector<NamedEstimate> estimates;
  for (int i = 0; i < 6; ++i) estimates.push_back({"walk " + std::to_string(i), walk(23.5 + 0.1 * i, {})});
  const auto chart = curves_of_many(estimates, "e", kDarkStyle);
  ASSERT_TRUE(chart);
  ASSERT_EQ(chart->series.size(), 6U);
  EXPECT_EQ(chart->title, "Mean distance per match e [mm]");
  EXPECT_EQ(chart->series[3].name, "walk 3 (23.80 ms)");
  EXPECT_EQ(chart->markers.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(chart->series[i].colour == chart->series[k].colour &&
                   chart->series[i].marker == chart->series[k].marker);
    }
  }
}

TEST(CurvesOfMany, NormalisedEachHasOneAtItsLeast) {
  const std::vector<NamedEstimate> estimates{{"a", walk(23.8, {})}, {"b", walk(24.4, {})}};
  const auto chart = curves_of_many(estimates, "e", kDarkStyle, Normalise::kByOptimum);
  ASSERT_TRUE(chart);
  EXPECT_EQ(chart->title, "Mean distance per match e / best e [1]");
  for (const ChartSeries& series : chart->series)
    EXPECT_DOUBLE_EQ(**std::min_element(series.y.begin(), series.y.end()), 1);
}

TEST(CurvesOfMany, RefuseWhatTheyCannotShow) {
  const std::vector<NamedEstimate> estimates{{"a", walk(23.8, {})}};
  EXPECT_EQ(curves_of_many(estimates, "x", kDarkStyle).error().message,
            "There is no criterion \"x\"; there are d, theta, e, n, roll, capped_cost");
  EXPECT_EQ(curves_of_many(estimates, "d", kDarkStyle).error().message,
            "None of the estimates has a value of the criterion \"d\"");
  EXPECT_EQ(curves_of_many(estimates, "roll", kDarkStyle, Normalise::kByOptimum).error().code,
            ExitCode::kWrongUsage);
}

TEST(Chart, AreasAndDashesReachThePixels) {
  Picture picture{100, 100, {0, 0, 0}, {}, {}};
  picture.marks.add(AreaMark{{{10, 40}, {50, 20}, {90, 40}}, 60, {0, 0, 255}});
  picture.marks.add(LineMark{{{10, 80}, {90, 80}}, 4, {255, 0, 0}, 10});
  const auto image = draw(picture);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->pixel(50, 25)[2], 255);
  EXPECT_EQ(image->pixel(15, 55)[2], 255);
  EXPECT_EQ(image->pixel(15, 30)[2], 0);  // above the line
  EXPECT_EQ(image->pixel(50, 65)[2], 0);  // below the base
  EXPECT_EQ(image->pixel(15, 80)[0], 255);
  EXPECT_EQ(image->pixel(25, 80)[0], 0);  // a gap
}

TEST(Dashes, AreAsLongAsTheirGapsAndTurnCorners) {
  const LineMark line{{{0, 0}, {10, 0}, {10, 10}}, 1, {}, 4};
  const auto dashes = dashes_of(line);
  ASSERT_EQ(dashes.size(), 3U);
  EXPECT_EQ(dashes[1].points.front().x, 8);
  EXPECT_EQ(dashes[1].points.back().y, 2);  // 2 px before the corner, 2 px after it
  EXPECT_EQ(dashes[2].points.front().y, 6);
  EXPECT_EQ(dashes_of({{{0, 0}, {10, 0}}, 1, {}}).size(), 1U);
}

TEST(OverTimeChart, ShowsWindowsWithTheirSigmasAndTheCourseThatBreaksAtItsJumps) {
  Estimate estimate;
  estimate.over_time = OffsetOverTime{
      {{0, 10, 5, 20 * kChartMs, 0.5 * kChartMs, {}},
       {10, 20, 15, {}, {}, "There are no scans."},
       {20, 30, 25, 25 * kChartMs, 0.5 * kChartMs, {}}},
      OffsetCourse{15, 20 * kChartMs, 0.1 * kChartMs, 0, 0, {{15, 20, 5 * kChartMs, 0.1 * kChartMs}}}};
  const auto chart = over_time_chart(estimate, style_of(Background::kWhite));
  ASSERT_TRUE(chart) << chart.error().message;
  ASSERT_EQ(chart->series.size(), 2U);
  const ChartSeries &windows = chart->series[0], &course = chart->series[1];
  EXPECT_FALSE(windows.joined);
  EXPECT_EQ(windows.x, (std::vector<double>{5, 15, 25}));
  EXPECT_FALSE(windows.y[1]) << "a gap";
  EXPECT_NEAR(windows.half_bars[2], 0.5, 1e-9);
  ASSERT_EQ(course.y.size(), 4U);
  EXPECT_NEAR(*course.y[1], 20, 1e-9);
  EXPECT_NEAR(*course.y[2], 25, 1e-9);
  EXPECT_NEAR(course.x[2], 17.5, 0.01);
  ASSERT_EQ(chart->verticals.size(), 1U);
  EXPECT_EQ(chart->verticals[0].label, "+5.00 ms");
  const ChartLayout layout = lay_out_chart(*chart, {0, 0, 640, 400}, 1);
  EXPECT_GT(layout.y_px(25.5), layout.plot.top) << "bars are inside";
  EXPECT_EQ(over_time_chart(Estimate{}, style_of(Background::kWhite)).error().code, ExitCode::kWrongUsage);
}

}  // namespace
}  // namespace sweepscope
