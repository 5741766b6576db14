#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/charts/curve_charts.hpp"
#include "render/charts/ticks.hpp"
#include "render/clouds/points.hpp"
#include "render/drawing/drawing.hpp"
#include "render/images/colour_table.hpp"
#include "tests/render/synthetic_maps.hpp"

namespace sweepscope {
namespace {

void expect_near(Colour actual, Colour expected, int steps) {
  EXPECT_NEAR(actual.red, expected.red, steps);
  EXPECT_NEAR(actual.green, expected.green, steps);
  EXPECT_NEAR(actual.blue, expected.blue, steps);
}

TEST(ColourTable, HasThePublishedColoursAtItsEndsAndMiddle) {
  const auto viridis = *colour_table("viridis"), cividis = *colour_table("cividis"),
             turbo = *colour_table("turbo");
  expect_near(viridis[0], {68, 1, 84}, 1);
  expect_near(viridis[128], {33, 145, 140}, 2);
  expect_near(viridis[255], {253, 231, 37}, 1);
  expect_near(cividis[0], {0, 32, 77}, 5);
  expect_near(cividis[128], {125, 124, 120}, 5);
  expect_near(cividis[255], {255, 234, 70}, 5);
  // The published fit strays from turbo's own table at the ends.
  expect_near(turbo[0], {48, 18, 59}, 34);
  expect_near(turbo[128], {164, 252, 60}, 20);
  expect_near(turbo[255], {122, 4, 3}, 24);
}

TEST(ColourTable, PerceptualTablesBrightenFromEndToEnd) {
  for (const char* name : {"viridis", "cividis", "grey"}) {
    const auto table = *colour_table(name);
    double before = -1;
    for (std::size_t i = 0; i < table.size(); i += 15) {
      const double brightness = 0.2126 * table[i].red + 0.7152 * table[i].green + 0.0722 * table[i].blue;
      EXPECT_GT(brightness, before) << name << " " << i;
      before = brightness;
    }
  }
}

TEST(ColourTable, AnUnknownNameIsAnsweredWithTheNamesThatThereAre) {
  EXPECT_EQ(colour_table("jet").error().message,
            "There is no colour table \"jet\"; there are viridis, cividis, turbo, grey");
}

TEST(ColourScale, ValuesBeyondTheRangeHaveItsEndsColours) {
  const ColourScale scale{*colour_table("viridis"), -1, 3};
  EXPECT_EQ(scale.at(-5), scale.table[0]);
  EXPECT_EQ(scale.at(9), scale.table[255]);
  EXPECT_EQ(scale.at(1), scale.table[128]);
}

TEST(Ticks, AreRoundNumbersWithAsManyDecimalsAsTheyNeed) {
  EXPECT_EQ(round_ticks(18.9, 29.1, 6).labels, (std::vector<std::string>{"20", "22", "24", "26", "28"}));
  EXPECT_EQ(round_ticks(-0.06, 0.07, 4).labels, (std::vector<std::string>{"−0.05", "0.00", "0.05"}));
  EXPECT_EQ(round_ticks(3, 3, 5).labels.size(), 0U);
}

TEST(Ticks, ARoundLengthIsTheGreatestThatFits) {
  EXPECT_EQ(round_length(7.3), 5);
  EXPECT_EQ(round_length(1), 1);
  EXPECT_EQ(round_length(0.35), 0.2);
  EXPECT_EQ(round_length(19.9), 10);
}

TEST(Thinning, KeepsTheFirstPointOfEachCube) {
  ColouredPoints points;
  points.add({0.0F, 0.0F, 0.0F}, 1);
  points.add({5.0F, 5.0F, 5.0F}, 2);
  points.add({0.4F, 0.4F, 0.4F}, 3);
  const ColouredPoints out = thin(points, 1.0);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out.values, (std::vector<float>{1, 2}));
}

TEST(Thinning, PutsNeighboursInSpaceNextToEachOther) {
  ColouredPoints points;
  for (int i = 0; i < 4096; ++i) {
    const int shuffled = i * 1237 % 4096;
    points.add({static_cast<float>(shuffled % 64), static_cast<float>(shuffled / 64), 0}, 0);
  }
  const ColouredPoints out = thin(points, 1.0);
  ASSERT_EQ(out.size(), 4096U);
  double jumps = 0;
  for (std::size_t i = 1; i < out.size(); ++i) {
    jumps += std::hypot(out.xyz_m[i][0] - out.xyz_m[i - 1][0], out.xyz_m[i][1] - out.xyz_m[i - 1][1]);
  }
  EXPECT_LT(jumps / 4096, 2);
}

TEST(Thinning, ADecimatedLevelHasFewPointsEverywhere) {
  ColouredPoints points;
  for (int i = 0; i < 100 * 100; ++i) {
    points.add({0.1F * static_cast<float>(i % 100), 0.1F * static_cast<float>(i / 100), 0}, 0);
  }
  const ColouredPoints few = decimated(points, 1000);
  EXPECT_LE(few.size(), 1000U);
  EXPECT_GE(few.size(), 1000U / 5);
  for (const auto& [x0, y0] : {std::pair{0.F, 0.F}, {5.F, 0.F}, {0.F, 5.F}, {5.F, 5.F}}) {
    std::size_t in_quarter = 0;
    for (const auto& p : few.xyz_m) {
      in_quarter += p[0] >= x0 && p[0] < x0 + 5 && p[1] >= y0 && p[1] < y0 + 5 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(in_quarter), static_cast<double>(few.size()) / 4,
                0.1 * static_cast<double>(few.size()));
  }
  EXPECT_EQ(decimated(points, 20'000).size(), points.size());
  EXPECT_EQ(decimated({}, 10).size(), 0U);
}

TEST(Text, WidthFollowsTheLettersAndTheirSize) {
  EXPECT_GT(text_width_px("offset", 20), text_width_px("off", 20));
  EXPECT_NEAR(text_width_px("offset θ", 40), 2 * text_width_px("offset θ", 20), 1e-9);
  EXPECT_GT(text_width_px("offset", 20, true), text_width_px("offset", 20));
}

TEST(Text, ThatIsTooLongIsCutBetweenLetters) {
  EXPECT_EQ(fit_text("short", 14, 500), "short");
  const std::string cut = fit_text("θθθθθθθθθθ", 14, 50);
  EXPECT_LE(text_width_px(cut, 14), 50);
  EXPECT_EQ(cut.substr(cut.size() - 3), "…");
  EXPECT_EQ((cut.size() - 3) % 2, 0U);
}

TEST(CurveCharts, AStationaryCurveHasDWithThetaAndTheRoll) {
  const std::vector<MarkedOffset> marked{{0.019, {1, 2, 3}}};
  const auto charts = curve_charts(test::stationary_curve(), marked, kDarkStyle);
  ASSERT_EQ(charts.size(), 2U);
  EXPECT_EQ(charts[0].series.size(), 2U);
  EXPECT_EQ(charts[1].title, "Alternating roll [°]");
  EXPECT_EQ(charts[0].x_title, "offset [ms]");
  EXPECT_EQ(charts[0].verticals[0].label, "19.0");
  EXPECT_EQ(charts[0].verticals[1].label, "found 24.00 ± 0.06");
  ASSERT_EQ(charts[0].markers.size(), 1U);
  EXPECT_NEAR(charts[0].markers[0].x, 24, 1e-9);
}

TEST(CurveCharts, AMovingCurveHasEInMillimetresAndN) {
  const auto charts = curve_charts(test::moving_curve(), {}, kDarkStyle);
  ASSERT_EQ(charts.size(), 3U);
  EXPECT_EQ(charts[0].title, "Mean distance per match e [mm]");
  EXPECT_NEAR(*charts[0].series[0].y[5], 11.2, 1e-9);
  EXPECT_EQ(charts[1].title, "Matches n [10³]");
}

TEST(CurveCharts, AFailedCandidateIsAGap) {
  const auto charts = curve_charts(test::stationary_curve(), {}, kDarkStyle);
  EXPECT_FALSE(charts[0].series[0].y[9].has_value());
  EXPECT_TRUE(charts[0].series[0].y[10].has_value());
}

TEST(CurveCharts, OffsetsShowTheDecimalsThatTheyHave) {
  EXPECT_EQ(offset_label_ms(0.024), "24.0");
  EXPECT_EQ(offset_label_ms(0.02405), "24.05");
  EXPECT_EQ(offset_label_ms(-0.0031), "−3.1");
  EXPECT_EQ(offset_label_ms(-1e-9), "0.0");
}

}  // namespace
}  // namespace sweepscope
