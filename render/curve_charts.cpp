#include "render/curve_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

constexpr double kDegPerRad = 180 / M_PI;

using Value = std::optional<double> CurvePoint::*;

bool has_any(const Estimate& estimate, Value value) {
  return std::any_of(estimate.curve.begin(), estimate.curve.end(),
                     [&](const auto& p) { return (p.*value).has_value(); });
}

ChartSeries series_of(const Estimate& estimate, Value value, double factor, std::string name, Colour colour) {
  ChartSeries series{std::move(name), {}, {}, colour};
  for (const CurvePoint& point : estimate.curve) {
    series.x.push_back(point.offset_s * 1e3);
    const auto& y = point.*value;
    series.y.push_back(y ? std::optional(*y * factor) : std::nullopt);
  }
  return series;
}

void mark_optimum(Chart& chart, const Estimate& estimate, const std::string& criterion, double factor,
                  Colour colour) {
  for (const CriterionOptimum& optimum : estimate.criteria) {
    if (optimum.name == criterion)
      chart.markers.push_back({optimum.offset_s * 1e3, optimum.value * factor, colour});
  }
}

/// Counts in thousands or millions, so that the axis stays readable.
std::pair<double, std::string> count_unit(const Estimate& estimate) {
  double greatest = 0;
  for (const CurvePoint& point : estimate.curve) greatest = std::max(greatest, point.n.value_or(0));
  if (greatest >= 2e6) return {1e-6, " [10⁶]"};
  if (greatest >= 2e4) return {1e-3, " [10³]"};
  return {1, ""};
}

std::vector<Chart> criteria_charts(const Estimate& estimate, const Style& style) {
  std::vector<Chart> charts;
  if (has_any(estimate, &CurvePoint::d)) {
    Chart chart;
    chart.title = "Motion seen between sweeps";
    chart.series.push_back(series_of(estimate, &CurvePoint::d, 1, "d", style.curve));
    if (has_any(estimate, &CurvePoint::rotation_rad)) {
      chart.series.push_back(
          series_of(estimate, &CurvePoint::rotation_rad, 1, "θ [rad]", style.second_curve));
    } else {
      chart.title += " d";
    }
    chart.with_zero = true;
    mark_optimum(chart, estimate, "d", 1, style.highlight);
    charts.push_back(std::move(chart));
  }
  if (has_any(estimate, &CurvePoint::e_m)) {
    Chart chart;
    chart.title = "Mean distance per match e [mm]";
    chart.series.push_back(series_of(estimate, &CurvePoint::e_m, 1e3, "e", style.curve));
    mark_optimum(chart, estimate, "e", 1e3, style.highlight);
    charts.push_back(std::move(chart));
  }
  if (has_any(estimate, &CurvePoint::n)) {
    const auto [factor, unit] = count_unit(estimate);
    Chart chart;
    chart.title = "Matches n" + unit;
    chart.series.push_back(series_of(estimate, &CurvePoint::n, factor, "n", style.curve));
    mark_optimum(chart, estimate, "n", factor, style.highlight);
    charts.push_back(std::move(chart));
  }
  if (has_any(estimate, &CurvePoint::signed_rotation_rad)) {
    Chart chart;
    chart.title = "Alternating roll [°]";
    chart.series.push_back(
        series_of(estimate, &CurvePoint::signed_rotation_rad, kDegPerRad, "roll", style.curve));
    chart.with_zero = true;
    charts.push_back(std::move(chart));
  }
  return charts;
}

std::string found_label(const Estimate& estimate) {
  std::string label = fmt::format("found {:.2f}", std::round(*estimate.offset_s * 1e5) / 1e2);
  if (estimate.sigma_s) label += fmt::format(" ± {:.2f}", *estimate.sigma_s * 1e3);
  return label;
}

}  // namespace

std::string offset_label_ms(double offset_s) {
  const double ms = std::round(offset_s * 1e6) / 1e3;
  const int decimals = std::abs(ms * 10 - std::round(ms * 10)) < 1e-6     ? 1
                       : std::abs(ms * 100 - std::round(ms * 100)) < 1e-6 ? 2
                                                                          : 3;
  std::string label = fmt::format("{:.{}f}", ms == 0 ? 0 : ms, decimals);
  if (label.front() == '-') label.replace(0, 1, "−");
  return label;
}

std::vector<Chart> curve_charts(const Estimate& estimate, std::span<const MarkedOffset> marked,
                                const Style& style) {
  std::vector<Chart> charts = criteria_charts(estimate, style);
  for (Chart& chart : charts) {
    chart.x_title = "offset [ms]";
    for (const MarkedOffset& mark : marked) {
      chart.verticals.push_back({mark.offset_s * 1e3, offset_label_ms(mark.offset_s), mark.colour});
    }
    if (estimate.identifiable && estimate.offset_s) {
      chart.verticals.push_back({*estimate.offset_s * 1e3, found_label(estimate), style.text, true});
    }
  }
  return charts;
}

}  // namespace sweepscope
