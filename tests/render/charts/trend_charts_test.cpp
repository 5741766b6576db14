#include "render/charts/trend_charts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/charts/chart_layout.hpp"
#include "render/charts/ticks.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kDay_ns = 86'400'000'000'000, kBegin_ns = 1'760'000'000'000'000'000;

CampaignRow row_of(std::optional<double> offset_ms, std::optional<std::int64_t> recorded_ns) {
  CampaignRow row;
  row.outcome = offset_ms ? RowOutcome::kAnswered : RowOutcome::kRefused;
  row.offset_ms = offset_ms;
  row.sigma_ms = 0.1;
  row.recorded_ns = recorded_ns;
  return row;
}

Campaign campaign() {
  return {ExpectedOffset{24, 0.5},
          {row_of(24.1, kBegin_ns), row_of(25.0, kBegin_ns + kDay_ns), row_of({}, kBegin_ns + 3 * kDay_ns),
           row_of(23.9, {})},
          {}};
}

TEST(TrendCharts, ShowWhatIsWithinOutsideAndWithoutAnOffset) {
  const auto charts = trend_charts(campaign(), kLightStyle);
  ASSERT_EQ(charts.size(), 2U);
  const Chart& chart = charts[0];
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].x, (std::vector<double>{1, 3, 4}));
  EXPECT_EQ(chart.series[0].y, (std::vector<std::optional<double>>{24.1, std::nullopt, 23.9}));
  EXPECT_EQ(chart.series[1].x, std::vector<double>{2});
  EXPECT_EQ(chart.series[1].half_bars, std::vector<double>{0.1});
  EXPECT_NE(chart.series[0].marker, chart.series[1].marker) << "not by colour alone";
  ASSERT_EQ(chart.y_bands.size(), 1U);
  EXPECT_EQ(chart.y_bands[0].from, 23.5);
  EXPECT_EQ(chart.y_bands[0].to, 24.5);
}

TEST(TrendCharts, OverDatesHoldTheRecordingsThatHaveThem) {
  const Chart chart = trend_charts(campaign(), kLightStyle).at(1);
  EXPECT_EQ(chart.x_dates_from_s, kBegin_ns / 1'000'000'000);
  EXPECT_EQ(chart.series[0].x, (std::vector<double>{0, 3 * 86'400.0}));
  EXPECT_EQ(chart.series[1].x, std::vector<double>{86'400.0});
  Campaign of_one_time = campaign();
  for (CampaignRow& row : of_one_time.rows) row.recorded_ns = kBegin_ns;
  EXPECT_EQ(trend_charts(of_one_time, kLightStyle).size(), 1U);
}

TEST(TrendCharts, CountRecordingsInWholeNumbersAndKeepTheBandInSight) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{11}, std::size_t{500}}) {
    Campaign many;
    many.expected = ExpectedOffset{24, 2};
    many.rows.assign(count, row_of(24.0, {}));
    const Chart chart = trend_charts(many, kLightStyle).at(0);
    const ChartLayout layout = lay_out_chart(chart, {0, 0, 900, 500}, 1);
    ASSERT_FALSE(layout.x_ticks.values.empty()) << count;
    for (const double tick : layout.x_ticks.values) EXPECT_EQ(tick, std::round(tick)) << count;
    EXPECT_LE(layout.y.from, 22);
    EXPECT_GE(layout.y.to, 26);
  }
}

TEST(DateTicks, StandAtRoundDatesOfEveryLength) {
  const std::int64_t from_s = 1'760'000'000;  // 2025-10-09 08:53:20
  const auto labels = [&](double length_s) { return date_ticks(0, length_s, 5, from_s).labels; };
  EXPECT_EQ(labels(4),
            (std::vector<std::string>{"08:53:20", "08:53:21", "08:53:22", "08:53:23", "08:53:24"}));
  EXPECT_EQ(labels(3600).front(), "10-09 09:00");
  EXPECT_EQ(labels(5 * 86'400.0).front(), "2025-10-10");
  EXPECT_EQ(labels(100 * 86'400.0), (std::vector<std::string>{"2025-11", "2025-12", "2026-01"}));
  EXPECT_EQ(labels(3 * 365 * 86'400.0), (std::vector<std::string>{"2026", "2027", "2028"}));
  EXPECT_LE(labels(100 * 365 * 86'400.0).size(), 6U);
  EXPECT_GE(labels(100 * 365 * 86'400.0).size(), 2U);
  EXPECT_TRUE(date_ticks(0, 0, 5, from_s).values.empty());
}

}  // namespace
}  // namespace sweepscope
