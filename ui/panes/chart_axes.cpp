#include "ui/panes/chart_axes.hpp"

#include <algorithm>

namespace sweepscope::ui {

// Two unseen lines at the ends of what the chart holds are drawn with it: where they come to lie is its axis.
ChartAxes axes_of(const Chart& chart, const PixelRect& place, const Style& style, double scale) {
  double least = 1e300, greatest = -1e300;
  const auto include = [&](double x) {
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  };
  for (const ChartSeries& series : chart.series) std::for_each(series.x.begin(), series.x.end(), include);
  for (const ChartVertical& vertical : chart.verticals) include(vertical.x);
  if (!(least < greatest)) return {place, 0, 1};
  Chart probed = chart;
  const Colour unseen{1, 2, 3, 0};
  probed.verticals.push_back({least, "", unseen, false});
  probed.verticals.push_back({greatest, "", unseen, false});
  Drawing drawing;
  add_chart(drawing, place, probed, style, scale);
  std::vector<PixelPoint> ends;
  for (const Drawing::Mark& mark : drawing.marks()) {
    const auto* line = std::get_if<LineMark>(&mark);
    if (line != nullptr && line->colour == unseen)
      ends.insert(ends.end(), line->points.begin(), line->points.end());
  }
  if (ends.size() != 4) return {place, least, greatest};
  const PixelRect span{ends[0].x, ends[0].y, ends[2].x - ends[0].x, ends[1].y - ends[0].y};
  return {span, least, greatest};
}

}  // namespace sweepscope::ui
