#include "render/charts/trend_charts.hpp"

#include <algorithm>
#include <functional>
#include <optional>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

/// Where a recording stands on the axis; nothing: not at all.
using Place = std::function<std::optional<double>(std::size_t index)>;

/// The rows that `shown` selects as single points.
ChartSeries series_of(const Campaign& campaign, const Place& place, std::string name, Colour colour,
                      MarkerShape marker, const std::function<bool(const CampaignRow&)>& shown) {
  ChartSeries series{std::move(name), {}, {}, colour, marker};
  series.joined = false;
  for (std::size_t i = 0; i < campaign.rows.size(); ++i) {
    const CampaignRow& row = campaign.rows[i];
    const auto x = place(i);
    if (!x || !shown(row)) continue;
    series.x.push_back(*x);
    series.y.push_back(row.offset_ms);
    series.half_bars.push_back(row.sigma_ms.value_or(0));
  }
  return series;
}

Chart chart_over(const Campaign& campaign, const Place& place, const Style& style) {
  Chart chart;
  chart.title = "Offset [ms]";
  chart.absent_name = "no offset";
  const auto outside = [&](const CampaignRow& row) { return is_outside(row, campaign.expected); };
  const auto inside = [&](const CampaignRow& row) { return !outside(row); };
  const std::string name = campaign.expected ? "within " + campaign.expected->words() : "offset";
  chart.series.push_back(series_of(campaign, place, name, style.curve, MarkerShape::kCircle, inside));
  if (std::ranges::any_of(campaign.rows, outside))
    chart.series.push_back(
        series_of(campaign, place, "outside", style.maps[0], MarkerShape::kTriangle, outside));
  if (campaign.expected)
    chart.y_bands.push_back({campaign.expected->offset_ms - campaign.expected->tolerance_ms,
                             campaign.expected->offset_ms + campaign.expected->tolerance_ms, style.maps[1]});
  return chart;
}

/// The earliest date, in whole seconds since 1970, if there are two different ones.
std::optional<std::int64_t> first_date_s(const Campaign& campaign) {
  std::vector<std::int64_t> dates_ns;
  for (const CampaignRow& row : campaign.rows)
    if (row.recorded_ns) dates_ns.push_back(*row.recorded_ns);
  const auto [first, last] = std::ranges::minmax_element(dates_ns);
  if (first == dates_ns.end() || *last - *first < kSecond_ns) return std::nullopt;
  return *first / kSecond_ns;
}

}  // namespace

std::vector<Chart> trend_charts(const Campaign& campaign, const Style& style) {
  const auto number = [](std::size_t index) { return std::optional(static_cast<double>(index + 1)); };
  std::vector<Chart> charts{chart_over(campaign, number, style)};
  charts.back().x_title = "recording, in the order given";
  charts.back().x_counts = true;
  if (const auto from_s = first_date_s(campaign)) {
    const auto date = [&](std::size_t index) -> std::optional<double> {
      const auto& recorded_ns = campaign.rows[index].recorded_ns;
      if (!recorded_ns) return std::nullopt;
      return static_cast<double>(*recorded_ns - *from_s * kSecond_ns) / kSecond_ns;
    };
    charts.push_back(chart_over(campaign, date, style));
    charts.back().x_title = "recorded [UTC]";
    charts.back().x_dates_from_s = from_s;
  }
  return charts;
}

}  // namespace sweepscope
