#include "ui/panes/chart_mouse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/charts/curve_charts.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// The offset at a pixel.
double value_at(const ChartLayout& layout, double px) {
  return layout.x.from + (px - layout.plot.left) / layout.plot.width * layout.x.length();
}

void begin_handle(const PaneContext& context, const ChartLayout& layout, Side side) {
  const double grab_ms = value_at(layout, mouse().x) - offset_ms(context.settings(), side);
  context.transient.handle =
      Transient::HandleDrag{side, layout.plot.left, layout.plot.width, layout.x.from, layout.x.to, grab_ms};
  context.begin_gesture();
}

/// Sets the offset of a map to one on the chart: in round steps, or near the offset found to that.
void move_offset(const PaneContext& context, Side side, double at_ms, const AxisRange& shown,
                 double plot_width) {
  constexpr double kSnap = 4;  // pixels at 100 %
  const double step_ms = shown.length() > 20 ? 0.1 : 0.01;
  double stepped_ms = std::round(std::round(at_ms / step_ms) * step_ms * 1e4) / 1e4;
  const std::optional<double> found_ms = context.explorer.found_offset_ms();
  if (found_ms && std::abs(at_ms - *found_ms) < context.px(kSnap) / plot_width * shown.length())
    stepped_ms = *found_ms;
  const auto [least_ms, greatest_ms] = context.explorer.offset_window_ms();
  context.perform(Call{find_command(side == Side::kA ? "offset-a" : "offset-b"),
                       {std::clamp(stepped_ms, least_ms, greatest_ms)}},
                  context.transient.gesture);
}

/// Once the mouse moved: a click on a handle changes nothing.
void drag_handle(const PaneContext& context) {
  const Transient::HandleDrag& handle = *context.transient.handle;
  if (!is_dragged(context, 0)) return;
  const AxisRange shown{handle.from_ms, handle.to_ms};
  const double share = (mouse().x - handle.plot_left) / handle.plot_width;
  move_offset(context, handle.side,
              shown.from + std::clamp(share, 0.0, 1.0) * shown.length() - handle.grab_ms, shown,
              handle.plot_width);
}

/// A click beside the handles brings the nearest one.
void bring_handle(const PaneContext& context, const ChartLayout& layout) {
  const double at_ms = value_at(layout, mouse().x);
  if (!layout.x.contains(at_ms)) return;
  const Settings& settings = context.settings();
  const Side top = context.explorer.changed_side();
  const auto apart_ms = [&](Side side) { return std::abs(offset_ms(settings, side) - at_ms); };
  const Side side = apart_ms(top) <= apart_ms(other_side(top)) ? top : other_side(top);
  context.transient.brought = Transient::Brought{side, offset_ms(settings, side)};
  move_offset(context, side, at_ms, layout.x, layout.plot.width);
}

void show(const PaneContext& context, const std::optional<AxisRange>& range, const std::string& gesture) {
  const auto rounded = [](double ms) { return std::round(ms * 1e3) / 1e3; };
  const AxisRange shown = range.value_or(AxisRange{0, 0});
  context.perform(Call{find_command("chart-range"), {rounded(shown.from), rounded(shown.to)}}, gesture);
}

/// A double click shows the whole axis: its first click brought no handle.
void show_all(const PaneContext& context) {
  if (const auto brought = std::exchange(context.transient.brought, std::nullopt))
    context.perform(
        Call{find_command(brought->side == Side::kA ? "offset-a" : "offset-b"), {brought->from_ms}},
        context.transient.gesture);
  show(context, std::nullopt, {});
  context.transient.handle.reset();
}

void begin_pan(const PaneContext& context, const ChartLayout& layout, std::size_t number) {
  context.transient.chart_pan =
      Transient::ChartPan{layout.plot.width, layout.x.from, layout.x.to, mouse().x, number};
  context.begin_gesture();
}

/// As far as there is something to see.
void pan(const PaneContext& context, const AxisRange& all) {
  const Transient::ChartPan& from = *context.transient.chart_pan;
  if (!is_dragged(context, held_button())) return;
  const double width_ms = from.to_ms - from.from_ms;
  if (width_ms >= all.length()) return;
  const double wanted_ms = from.from_ms - (mouse().x - from.mouse_px) / from.plot_width * width_ms;
  const double begin_ms = std::clamp(wanted_ms, all.from, all.to - width_ms);
  show(context, AxisRange{begin_ms, begin_ms + width_ms}, context.transient.gesture);
}

void zoom(const PaneContext& context, const ChartLayout& layout, const AxisRange& all) {
  const double wheel = static_cast<double>(ImGui::GetIO().MouseWheel);
  if (wheel == 0) return;
  show(context, zoomed_range(layout.x, std::pow(1.2, wheel), value_at(layout, mouse().x), all),
       "wheel over the charts");
}

/// A line at the candidate nearest to the mouse, and what the curves say there.
void show_values(const PaneContext& context, const Chart& chart, const ChartLayout& layout,
                 std::size_t number) {
  const std::vector<ChartReading> readings = read_chart(chart, value_at(layout, mouse().x));
  if (readings.empty()) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto x = static_cast<float>(layout.x_px(readings.front().x));
  list.AddLine({x, static_cast<float>(layout.plot.top)}, {x, static_cast<float>(layout.plot.bottom())},
               to_imgui(context.style.faint_text, 0.6));
  std::string words = fmt::format("offset {} ms", offset_label_ms(readings.front().x * 1e-3));
  for (const ChartReading& reading : readings) {
    list.AddCircle({x, static_cast<float>(layout.y_px(reading.y))}, context.pxf(4.5),
                   to_imgui(context.style.highlight), 0, context.pxf(1.5));
    words += fmt::format("\n{} {:.4g} {}", reading.series->name, reading.y, reading.series->unit);
  }
  context.anchor(fmt::format("chart value {}", number),
                 {static_cast<double>(x), layout.plot.top, 1, layout.plot.height});
  // Beside the mouse, and below the chart's title in any case.
  const ImVec2 at = ImGui::GetIO().MousePos;
  ImGui::SetNextWindowPos(
      {at.x + context.pxf(14),
       std::max(at.y + context.pxf(10), static_cast<float>(layout.plot.top) + context.pxf(4))});
  ImGui::SetTooltip("%s", words.c_str());
}

}  // namespace

PixelRect grip_of(const ChartLayout& layout, double at_ms, double scale) {
  const double x = layout.x_px(at_ms), foot = layout.plot.bottom();
  return {x - 7 * scale, foot - 12.6 * scale, 14 * scale, 17.1 * scale};
}

std::optional<Side> handle_under(const ChartLayout& layout, const Settings& settings, Side top,
                                 PixelPoint mouse, double scale) {
  const std::array sides{top, other_side(top)};
  for (const Side side : sides)
    if (grip_of(layout, offset_ms(settings, side), scale).contains(mouse)) return side;
  std::optional<Side> nearest;
  double nearest_px = 6 * scale;
  for (const Side side : sides) {
    const double apart_px = std::abs(layout.x_px(offset_ms(settings, side)) - mouse.x);
    if (apart_px >= nearest_px) continue;
    nearest_px = apart_px;
    nearest = side;
  }
  return nearest;
}

std::optional<AxisRange> zoomed_range(const AxisRange& shown, double factor, double about,
                                      const AxisRange& all) {
  constexpr double kMin_ms = 0.1;
  const double width = std::max(shown.length() / factor, kMin_ms);
  if (width >= all.length()) return std::nullopt;
  const double from = about - (about - shown.from) / shown.length() * width;
  const double begin = std::clamp(from, all.from, all.to - width);
  return AxisRange{begin, begin + width};
}

void use_chart_mouse(const PaneContext& context, const Chart& chart, const ChartLayout& layout,
                     const AxisRange& all, std::size_t number) {
  const double reach = context.px(12);
  invisible_button(fmt::format("chart {}", number),
                   {layout.plot.left - reach, layout.plot.top - reach, layout.plot.width + 2 * reach,
                    layout.plot.height + 2 * reach},
                   kAnyButton);
  context.anchor(fmt::format("chart {}", number), layout.plot);
  Transient& transient = context.transient;
  const bool hovered = ImGui::IsItemHovered();
  const auto under =
      handle_under(layout, context.settings(), context.explorer.changed_side(), mouse(), context.scale);
  if (hovered && ImGui::IsMouseDoubleClicked(0)) {
    show_all(context);
  } else if (ImGui::IsItemActivated()) {
    if (under && ImGui::IsMouseDown(0))
      begin_handle(context, layout, *under);
    else
      begin_pan(context, layout, number);
  }
  const bool active = ImGui::IsItemActive();
  if (active && transient.handle) drag_handle(context);
  if (!active && transient.chart_pan && transient.chart_pan->chart == number) {
    if (ImGui::IsMouseReleased(0) && hovered && !is_dragged(context, 0)) bring_handle(context, layout);
    transient.chart_pan.reset();
  }
  if (active && transient.chart_pan) pan(context, all);
  if (hovered && !active) zoom(context, layout, all);
  if ((hovered && under) || transient.handle) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (hovered && !active && !under) show_values(context, chart, layout, number);
}

}  // namespace sweepscope::ui
