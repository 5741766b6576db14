#include "render/charts/curve_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/prepared/candidates.hpp"

namespace sweepscope {
namespace {

/// What a curve can hold, and how it is shown.
struct Quantity {
  std::string_view key;
  CurveValue value = nullptr;
  const char *symbol = "", *title = "", *unit = "";
  double factor = 1;  // from the curve's unit to the one shown
  bool with_zero = false;
};

constexpr std::array<Quantity, 6> kQuantities{{
    {"d", &CurvePoint::d, "d", "Motion between sweeps", "m", 1, true},
    {"theta", &CurvePoint::rotation_rad, "θ", "Rotation between sweeps", "rad", 1, true},
    {"e", &CurvePoint::e_m, "e", "Mean distance per match", "mm", 1e3, false},
    {"n", &CurvePoint::n, "n", "Matches", "1", 1, false},
    {"roll", &CurvePoint::signed_rotation_rad, "roll", "Alternating roll", "°", 180 / M_PI, true},
    {"capped_cost", &CurvePoint::capped_cost_m, "c", "Capped distance", "mm", 1e3, false},
}};
constexpr const Quantity &kD = kQuantities[0], &kTheta = kQuantities[1], &kRoll = kQuantities[4],
                         &kCappedCost = kQuantities[5];

bool has_any(const Estimate& estimate, const Quantity& quantity) {
  return std::any_of(estimate.curve.begin(), estimate.curve.end(),
                     [&](const auto& p) { return (p.*quantity.value).has_value(); });
}

/// Counts in thousands or millions, so that the axis stays readable.
Quantity in_readable_unit(Quantity quantity, std::span<const NamedEstimate> estimates) {
  if (quantity.value != &CurvePoint::n) return quantity;
  double max_n = 0;
  for (const NamedEstimate& one : estimates) {
    for (const CurvePoint& point : one.estimate.curve) max_n = std::max(max_n, point.n.value_or(0));
  }
  if (max_n >= 2e6) {
    quantity.factor = 1e-6, quantity.unit = "10⁶";
  } else if (max_n >= 2e4) {
    quantity.factor = 1e-3, quantity.unit = "10³";
  }
  return quantity;
}

std::string title_of(const Quantity& quantity) {
  if (quantity.value == kRoll.value) return fmt::format("{} [{}]", quantity.title, quantity.unit);
  return fmt::format("{} {} [{}]", quantity.title, quantity.symbol, quantity.unit);
}

ChartSeries series_of(const Estimate& estimate, const Quantity& quantity, Colour colour) {
  ChartSeries series{quantity.symbol, {}, {}, colour};
  for (const CurvePoint& point : estimate.curve) {
    series.x.push_back(point.offset_s * 1e3);
    const auto& y = point.*quantity.value;
    series.y.push_back(y ? std::optional(*y * quantity.factor) : std::nullopt);
  }
  series.unit = quantity.unit == std::string_view("1") ? "" : quantity.unit;
  return series;
}

const CriterionOptimum* optimum_of(const Estimate& estimate, std::string_view criterion) {
  for (const CriterionOptimum& optimum : estimate.criteria) {
    if (optimum.name == criterion) return &optimum;
  }
  return nullptr;
}

/// The fit behind an optimum as a smooth curve over the points that it was fitted to.
ChartSeries series_of_fit(const ExtremumFit& fit, double factor, Colour colour) {
  constexpr int kSteps = 64;
  ChartSeries series{"fit", {}, {}, colour, MarkerShape::kNone, true};
  for (int i = 0; i <= kSteps; ++i) {
    const double offset_s = fit.from_s + (fit.to_s - fit.from_s) * i / kSteps;
    series.x.push_back(offset_s * 1e3);
    series.y.push_back(fit.at(offset_s) * factor);
  }
  return series;
}

Chart chart_of(const Estimate& estimate, const Quantity& quantity, const Style& style) {
  Chart chart;
  chart.title = title_of(quantity);
  chart.with_zero = quantity.with_zero;
  chart.series.push_back(series_of(estimate, quantity, style.curve));
  if (quantity.value == kD.value && has_any(estimate, kTheta)) {
    chart.title = "Motion between sweeps d [m], θ [rad]";
    ChartSeries theta = series_of(estimate, kTheta, style.second_curve);
    theta.marker = MarkerShape::kSquare;
    chart.series.push_back(std::move(theta));
  }
  if (const CriterionOptimum* optimum = optimum_of(estimate, quantity.key)) {
    if (const auto fit = fit_behind(estimate.curve, quantity.value, *optimum))
      chart.series.push_back(series_of_fit(*fit, quantity.factor, style.second_curve));
    chart.markers.push_back({optimum->offset_s * 1e3, optimum->value * quantity.factor, style.highlight});
  }
  return chart;
}

std::string found_label(const Estimate& estimate) {
  std::string label = fmt::format("found {:.2f}", std::round(*estimate.offset_s * 1e5) / 1e2);
  if (estimate.sigma_s) label += fmt::format(" ± {:.2f}", *estimate.sigma_s * 1e3);
  return label;
}

void mark_offsets(Chart& chart, const Estimate& estimate, std::span<const MarkedOffset> marked,
                  const Style& style) {
  for (const MarkedOffset& mark : marked) {
    chart.verticals.push_back({mark.offset_s * 1e3, offset_label_ms(mark.offset_s), mark.colour});
  }
  if (!estimate.identifiable || !estimate.offset_s) return;
  const double offset_ms = *estimate.offset_s * 1e3;
  chart.verticals.push_back({offset_ms, found_label(estimate), style.text, true});
  if (!estimate.sigma_s) return;
  const double sigma_ms = *estimate.sigma_s * 1e3;
  chart.bands.push_back({offset_ms - sigma_ms, offset_ms + sigma_ms, style.text});
}

Result<Quantity> quantity_named(std::string_view key) {
  std::string known;
  for (const Quantity& quantity : kQuantities) {
    if (quantity.key == key) return quantity;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", quantity.key);
  }
  return failure(ExitCode::kWrongUsage,
                 fmt::format("There is no criterion \"{}\"; there are {}", key, known));
}

/// One divided by the value of an estimate's best candidate.
double normalising_factor(const Estimate& estimate, const Quantity& quantity) {
  const std::size_t best = quantity.value == &CurvePoint::n ? index_of_max(estimate.curve, quantity.value)
                                                            : index_of_min(estimate.curve, quantity.value);
  if (best == estimate.curve.size()) return 1;
  const double value = *(estimate.curve[best].*quantity.value);
  return value == 0 ? 1 : 1 / value;
}

/// The look of the one of many curves: colours repeat after four, with other shapes.
void set_look(ChartSeries& series, std::size_t index, const Style& style) {
  constexpr std::array kShapes{MarkerShape::kCircle, MarkerShape::kSquare, MarkerShape::kTriangle,
                               MarkerShape::kDiamond};
  const std::size_t colours = style.maps.size();
  series.colour = style.maps[index % colours];
  series.marker = kShapes[(index + index / colours) % kShapes.size()];
}

void add_one_of_many(Chart& chart, const NamedEstimate& one, Quantity quantity, Normalise normalise,
                     const Style& style) {
  if (!has_any(one.estimate, quantity)) return;
  if (normalise == Normalise::kByOptimum) quantity.factor = normalising_factor(one.estimate, quantity);
  ChartSeries series = series_of(one.estimate, quantity, style.curve);
  set_look(series, chart.series.size(), style);
  series.name = one.name;
  if (one.estimate.identifiable && one.estimate.offset_s)
    series.name += fmt::format(" ({:.2f} ms)", *one.estimate.offset_s * 1e3);
  if (const CriterionOptimum* optimum = optimum_of(one.estimate, quantity.key)) {
    chart.markers.push_back(
        {optimum->offset_s * 1e3, optimum->value * quantity.factor, series.colour, series.marker});
  }
  chart.series.push_back(std::move(series));
}

Chart marked_chart(const Estimate& estimate, const Quantity& quantity, std::span<const MarkedOffset> marked,
                   const Style& style) {
  const std::array<NamedEstimate, 1> alone{{{"", estimate}}};
  Chart chart = chart_of(estimate, in_readable_unit(quantity, alone), style);
  chart.x_title = "offset [ms]";
  chart.absent_name = "failed";
  mark_offsets(chart, estimate, marked, style);
  return chart;
}

/// The coarse search of the direct method, whose least squares has no candidates.
Chart coarse_chart(const Estimate& estimate, std::span<const MarkedOffset> marked, const Style& style) {
  Estimate coarse = estimate;
  std::erase_if(coarse.curve, [](const CurvePoint& point) { return point.e_m || !point.capped_cost_m; });
  Chart chart = marked_chart(coarse, kCappedCost, marked, style);
  chart.title = "Distance between sweeps c [mm]";
  return chart;
}

Error without_value(std::string_view criterion) {
  return {ExitCode::kWrongUsage,
          fmt::format("None of the estimates has a value of the criterion \"{}\"", criterion)};
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
  if (estimate.method == Method::kDirect && has_any(estimate, kCappedCost))
    return {coarse_chart(estimate, marked, style)};
  std::vector<Chart> charts;
  for (const Quantity& quantity : kQuantities) {
    if (quantity.value == kTheta.value || !has_any(estimate, quantity)) continue;
    if (quantity.value == kCappedCost.value && !charts.empty()) continue;
    charts.push_back(marked_chart(estimate, quantity, marked, style));
  }
  return charts;
}

Result<Chart> curve_chart(const Estimate& estimate, std::string_view criterion,
                          std::span<const MarkedOffset> marked, const Style& style) {
  return quantity_named(criterion).and_then([&](const Quantity& quantity) -> Result<Chart> {
    if (!has_any(estimate, quantity)) return tl::unexpected(without_value(criterion));
    return marked_chart(estimate, quantity, marked, style);
  });
}

Result<Chart> curves_of_many(std::span<const NamedEstimate> estimates, std::string_view criterion,
                             const Style& style, Normalise normalise) {
  const Result<Quantity> named = quantity_named(criterion);
  if (!named) return tl::unexpected(named.error());
  if (normalise == Normalise::kByOptimum && named->value == kRoll.value)
    return failure(ExitCode::kWrongUsage, "The alternating roll cannot be normalised: it passes through 0");
  const Quantity quantity = in_readable_unit(*named, estimates);
  Chart chart;
  chart.title = normalise == Normalise::kNo
                    ? title_of(quantity)
                    : fmt::format("{0} {1} / best {1} [1]", quantity.title, quantity.symbol);
  chart.x_title = "offset [ms]";
  chart.absent_name = "failed";
  chart.with_zero = quantity.with_zero;
  for (const NamedEstimate& one : estimates) add_one_of_many(chart, one, quantity, normalise, style);
  if (chart.series.empty()) return tl::unexpected(without_value(criterion));
  return chart;
}

}  // namespace sweepscope
