#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/drawing/drawing.hpp"
#include "render/drawing/style.hpp"

namespace sweepscope {

/// The symbol at a series' points. The shapes distinguish series if colours do not.
enum class MarkerShape { kNone, kCircle, kSquare, kTriangle, kDiamond };

struct ChartSeries {
  std::string name;  // in the legend; empty: not listed
  std::vector<double> x;
  std::vector<std::optional<double>> y;  // absent values leave a gap, and a tick on the axis below
  Colour colour;
  MarkerShape marker = MarkerShape::kCircle;
  bool dashed = false;                 // thin dashes, for fits
  bool filled = false;                 // down to 0, which the axis then includes
  bool joined = true;                  // by lines from point to point
  std::vector<double> half_bars = {};  // like x: half the height of the bar at each point; empty: none
  std::string unit = {};               // of y, where the title does not say it of all series
};

struct AxisRange {
  double from = 0, to = 1;

  bool contains(double value) const { return value >= from && value <= to; }
  double length() const { return to - from; }
};

/// A vertical line across the chart with a label above it.
struct ChartVertical {
  double x = 0;
  std::string label;
  Colour colour;
  bool dashed = false;
};

struct ChartMarker {
  double x = 0, y = 0;
  Colour colour;
  MarkerShape shape = MarkerShape::kDiamond;
};

/// A shaded range of x, such as an uncertainty, or of y, such as where values are expected.
struct ChartBand {
  double from = 0, to = 0;
  Colour colour;
};

/// A horizontal bar with ends, such as a width at half height, with its label beside it.
struct ChartSpan {
  double y = 0, from = 0, to = 0;
  std::string label;
  Colour colour;
};

/// A chart of lines as data. Axes fit the data that is shown, and without values y has no numbers;
/// `with_zero` extends y to 0 and draws a line there.
struct Chart {
  std::string title;    // what y is, with its unit
  std::string x_title;  // what x is, with its unit
  std::vector<ChartSeries> series;
  std::vector<ChartVertical> verticals;
  std::vector<ChartMarker> markers;
  bool with_zero = false;
  std::vector<ChartBand> bands;
  std::vector<ChartSpan> spans;
  std::string absent_name;  // what an absent value means, in the legend
  std::vector<ChartBand> y_bands{};
  bool x_counts = false;                         // x are whole numbers, as are the ticks
  std::optional<std::int64_t> x_dates_from_s{};  // x is a date: seconds since this one, which is since 1970
  std::optional<AxisRange> x_range{};            // what is shown, exactly; empty: all, with room at both ends
};

/// What a series says at its point nearest to an x.
struct ChartReading {
  const ChartSeries* series = nullptr;
  double x = 0, y = 0;
};
/// Of each series with markers, at the x of the first one's shown point nearest to `x`; absent values are
/// left out. The chart must outlive it.
std::vector<ChartReading> read_chart(const Chart& chart, double x);

/// Draws the chart with its title, legend and labels inside `place`; `scale` is 1 for letters of 13 px.
void add_chart(Drawing& drawing, const PixelRect& place, const Chart& chart, const Style& style,
               double scale);

}  // namespace sweepscope
