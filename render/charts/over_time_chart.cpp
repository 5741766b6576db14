#include "render/charts/over_time_chart.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sweepscope {
namespace {

ChartSeries series_of(const std::vector<OffsetWindow>& windows, Colour colour) {
  ChartSeries series{"window", {}, {}, colour};
  series.joined = false;
  for (const OffsetWindow& window : windows) {
    series.x.push_back(window.time_s);
    series.y.push_back(window.offset_s ? std::optional(*window.offset_s * 1e3) : std::nullopt);
    series.half_bars.push_back(window.sigma_s.value_or(0) * 1e3);
  }
  return series;
}

/// Straight between the jumps: two points for each stretch.
ChartSeries series_of(const OffsetCourse& course, double begin_s, double end_s, Colour colour) {
  std::string name = course.jumps.empty() && course.constant() ? "constant" : "fit";
  if (course.rate_sigma > 0) name = fmt::format("{:.2f} ppm", course.rate * 1e6);
  ChartSeries series{std::move(name), {}, {}, colour, MarkerShape::kNone};
  double from_s = begin_s;
  const auto add = [&](double to_s) {
    const double sliver_s = 1e-6 * (to_s - from_s);
    for (const double time_s : {from_s + sliver_s, to_s - sliver_s}) {
      series.x.push_back(time_s);
      series.y.push_back(course.offset_at_s(time_s) * 1e3);
    }
    from_s = to_s;
  };
  for (const OffsetJump& jump : course.jumps) add((jump.begin_s + jump.end_s) / 2);
  add(end_s);
  return series;
}

}  // namespace

Result<Chart> over_time_chart(const Estimate& estimate, const Style& style) {
  if (!estimate.over_time || estimate.over_time->windows.empty())
    return failure(
        ExitCode::kWrongUsage,
        fmt::format("{}: the estimate has no windows: it was made without over-time", estimate.recording));
  const OffsetOverTime& over_time = *estimate.over_time;
  Chart chart;
  chart.title = "Offset [ms]";
  chart.x_title = "time since the first scan [s]";
  chart.absent_name = "not determined";
  chart.series.push_back(series_of(over_time.windows, style.curve));
  if (over_time.course)
    chart.series.push_back(series_of(*over_time.course, over_time.windows.front().begin_s,
                                     over_time.windows.back().end_s, style.second_curve));
  if (over_time.course)
    for (const OffsetJump& jump : over_time.course->jumps)
      chart.verticals.push_back({(jump.begin_s + jump.end_s) / 2,
                                 fmt::format("{:+.2f} ms", jump.size_s * 1e3), style.faint_text, true});
  return chart;
}

}  // namespace sweepscope
