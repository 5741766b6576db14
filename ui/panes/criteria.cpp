#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "core/offset/prepared/search_window.hpp"
#include "render/charts/curve_charts.hpp"
#include "ui/host/paint.hpp"
#include "ui/panes/chart_mouse.hpp"
#include "ui/panes/closer.hpp"
#include "ui/panes/over_time_strip.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

constexpr Colour kUnseen{0, 0, 0, 0};

/// Before there is an estimate: what the handles can be moved over.
Chart empty_chart(const PaneContext& context) {
  const double reach_ms =
      1e3 * std::min(search_scale(context.explorer.loaded()->prepared.motor).half_width_s, 0.06);
  Chart chart;
  chart.title = "Criteria over the offset";
  chart.x_title = "offset [ms]";
  for (const double end : {-reach_ms, reach_ms}) chart.verticals.push_back({end, "", kUnseen});
  for (const Side side : kBothSides) {
    const double at = offset_ms(context.settings(), side);
    chart.verticals.push_back({at, offset_label_ms(at * 1e-3), colour_of(context, side)});
  }
  return chart;
}

/// The offsets of both maps; the line on top, which a drag moves, comes last.
std::array<MarkedOffset, 2> marked_offsets(const PaneContext& context) {
  const auto marked = [&](Side side) {
    return MarkedOffset{offset_ms(context.settings(), side) * 1e-3, colour_of(context, side)};
  };
  const Side top = context.explorer.changed_side();
  return {marked(other_side(top)), marked(top)};
}

/// The part of the axis that is shown: while a handle is dragged as it was when the drag began, or the handle
/// would run away from the mouse.
std::optional<AxisRange> range_shown(const PaneContext& context) {
  const auto& handle = context.transient.handle;
  if (handle) return AxisRange{handle->from_ms, handle->to_ms};
  const Settings& settings = context.settings();
  if (settings.chart_to_ms <= settings.chart_from_ms) return std::nullopt;
  return AxisRange{settings.chart_from_ms, settings.chart_to_ms};
}

std::vector<Chart> charts_of(const PaneContext& context) {
  const Estimate* estimate = context.explorer.estimating.charted();
  std::vector<Chart> charts;
  if (estimate != nullptr) charts = curve_charts(*estimate, marked_offsets(context), context.style);
  if (charts.empty()) charts.push_back(empty_chart(context));
  return charts;
}

/// What the chart's title means, with its equation.
std::string meaning(const std::string& title) {
  if (title.starts_with("Motion"))
    return "d = √(t² + c θ²), equation 3: the motion that odometry registers between sweeps of a stationary "
           "rig, from the translation t (equation 1) and the rotation θ (equation 2). Its minimum is at the "
           "offset.";
  if (title.starts_with("Mean distance"))
    return "e, equation 7: the mean distance of the matches from their line or plane on the map. Its minimum "
           "is at the offset.";
  if (title.starts_with("Matches"))
    return "n, equation 6: the number of edge and plane points that match the map, within the gates of "
           "equations 4 and 5. Its maximum is at the offset.";
  if (title.starts_with("Alternating"))
    return "The roll between sweeps of opposite directions: twice the motor's speed times the error of the "
           "offset. Zero at the offset.";
  if (title.starts_with("Distance between"))
    return "The coarse search of the direct method: the mean distance between sweeps of opposite directions "
           "at equal motor angles, each distance capped. Its minimum is near the offset; a least-squares fit "
           "then finds the offset to a fraction of a millisecond.";
  return "Estimate the offset to see the criteria over the candidates here.";
}

/// Grips at the feet of the two lines, the one that a drag moves on top.
void draw_grips(const PaneContext& context, const ChartLayout& layout) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Side top = context.explorer.changed_side();
  for (const Side side : {other_side(top), top}) {
    const double at = offset_ms(context.settings(), side);
    if (!layout.x.contains(at)) continue;
    const PixelRect grip = grip_of(layout, at, context.scale);
    const auto x = static_cast<float>(grip.left + grip.width / 2), w = static_cast<float>(grip.width / 2);
    const auto from = static_cast<float>(grip.top), to = static_cast<float>(grip.bottom());
    const float shoulder = from + 0.37f * (to - from);
    const ImVec2 points[5] = {{x, from}, {x + w, shoulder}, {x + w, to}, {x - w, to}, {x - w, shoulder}};
    list.AddConvexPolyFilled(points, 5, to_imgui(colour_of(context, side)));
    ImGui::PushFont(context.fonts.small);
    const char* letter = side == Side::kA ? "A" : "B";
    const ImVec2 size = ImGui::CalcTextSize(letter);
    list.AddText({std::round(x - size.x / 2), std::round(from + 0.66f * (to - from) - size.y / 2)},
                 to_imgui(context.style.page), letter);
    ImGui::PopFont();
    context.anchor(side == Side::kA ? "handle a" : "handle b", grip);
  }
}

/// Why the chart has no curve.
std::array<const char*, 2> words_without_curve(const RunningEstimate& estimating) {
  if (estimating.is_running()) return {"Estimating the offset.", "The criteria appear here."};
  const Estimate* found = estimating.found();
  if (found != nullptr && found->together)
    return {"The answer from several recordings has no chart.",
            "Estimate this recording alone to see its criteria."};
  if (found != nullptr)
    return {"There are no criteria: the offset is not determined.", "Drag A and B to compare two offsets."};
  return {"Estimate the offset to see the criteria here.", "Or drag A and B now."};
}

/// Each sentence on lines of its own that fit.
std::vector<std::string> hint_lines(const PaneContext& context, double width_px) {
  std::vector<std::string> lines;
  for (const char* sentence : words_without_curve(context.explorer.estimating)) {
    std::istringstream broken(in_lines(sentence, static_cast<float>(width_px)));
    for (std::string line; std::getline(broken, line);) lines.push_back(line);
  }
  return lines;
}

/// Over the empty chart, on a plate so that grid and handles pass behind it.
void draw_hint(const PaneContext& context, const PixelRect& plot) {
  const double size_px = context.px(13), line_px = context.px(19), margin = context.px(8);
  const std::vector<std::string> lines = hint_lines(context, plot.width - 2 * margin);
  double width = 0;
  for (const std::string& line : lines) width = std::max(width, text_width_px(line, size_px) + 2 * margin);
  const double height = static_cast<double>(lines.size()) * line_px + margin;
  if (width > plot.width || height > plot.height) return;
  // Above the handles' grips.
  const PixelPoint middle{plot.left + plot.width / 2, plot.top + (plot.height - margin) * 0.42};
  const double top = std::max(plot.top, middle.y - height / 2);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const PixelRect plate{middle.x - width / 2, top, width, height};
  list.AddRectFilled(corner(plate), far_corner(plate), to_imgui(context.style.panel), context.pxf(3));
  for (std::size_t i = 0; i < lines.size(); ++i)
    paint_text(list, context.fonts, {middle.x, top + margin / 2 + (static_cast<double>(i) + 0.5) * line_px},
               lines[i], size_px, context.style.faint_text, AlignX::kCentre, AlignY::kMiddle);
}

void draw_one(const PaneContext& context, Chart chart, const PixelRect& place, std::size_t number) {
  const double scale = context.scale * 0.86;
  const AxisRange all = lay_out_chart(chart, place, scale).x;
  chart.x_range = range_shown(context);
  Drawing drawing;
  add_chart(drawing, place, chart, context.style, scale);
  paint(*ImGui::GetWindowDrawList(), drawing, context.fonts);
  const ChartLayout layout = lay_out_chart(chart, place, scale);
  if (chart.series.empty()) draw_hint(context, layout.plot);
  // Before the mouse moves them: line, grip and number show the same offset in every frame.
  if (number == 0) draw_grips(context, layout);
  use_chart_mouse(context, chart, layout, all, number);
  invisible_button(fmt::format("chart title {}", number),
                   {place.left, place.top, place.width * 0.6, context.px(18)});
  context.anchor_last(fmt::format("chart title {}", number));
  tooltip(context, meaning(chart.title), TooltipPlace::kBelow);
}

}  // namespace

void draw_criteria(const PaneContext& context, const PixelRect& place) {
  if (place.height <= 0) return;
  begin_panel(context, "criteria", place, false);
  const std::vector<Chart> charts = charts_of(context);
  const bool scan = context.settings().scan_view;
  const bool profile = !scan && (context.settings().tool == Tool::kProfile ||
                                 context.settings().profile_from_m != context.settings().profile_to_m);
  const bool windows = !scan && !profile && has_windows(context);
  const bool closer = scan || profile || windows;
  const double margin = context.px(12), gap = context.px(22), least = context.px(250);
  const double room = place.width - 2 * margin;
  const auto fitting = std::max<std::size_t>(1, static_cast<std::size_t>((room + gap) / (least + gap)));
  const std::size_t parts = closer ? std::min<std::size_t>(fitting, 3) : std::min(charts.size(), fitting);
  const double width = (room - gap * static_cast<double>(parts - 1)) / static_cast<double>(parts);
  const auto part = [&](std::size_t from, std::size_t count) {
    const double left = place.left + margin + static_cast<double>(from) * (width + gap);
    const double wide = width * static_cast<double>(count) + gap * static_cast<double>(count - 1);
    return PixelRect{std::round(left), std::round(place.top + context.px(8)), std::round(wide),
                     place.height - context.px(10)};
  };
  // A closer look takes the place of all charts but the first, whose handles stay at hand.
  const std::size_t shown = closer ? std::min<std::size_t>(parts - 1, 1) : parts;
  for (std::size_t i = 0; i < shown; ++i) draw_one(context, charts[i], part(i, 1), i);
  if (scan) draw_scan_view(context, part(shown, parts - shown));
  if (profile) draw_profile_chart(context, part(shown, parts - shown));
  if (windows) draw_over_time_strip(context, part(shown, parts - shown));
  end_panel();
}

}  // namespace sweepscope::ui
