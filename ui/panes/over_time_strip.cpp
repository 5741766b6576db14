#include "ui/panes/over_time_strip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/printable_text.hpp"
#include "render/charts/chart_layout.hpp"
#include "render/charts/over_time_chart.hpp"
#include "ui/host/paint.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

std::string words_of(const OffsetWindow& window) {
  const std::string when = fmt::format("{:.1f} to {:.1f} s", window.begin_s, window.end_s);
  if (!window.offset_s) return when + "\n" + printable_line(window.reason);
  return fmt::format("{}\noffset {:.3f} ± {:.3f} ms", when, *window.offset_s * 1e3,
                     window.sigma_s.value_or(0) * 1e3);
}

/// A line through the window nearest to the mouse, and its words.
void show_window(const PaneContext& context, const OffsetOverTime& over_time, const ChartLayout& layout) {
  const double mouse_px = static_cast<double>(ImGui::GetIO().MousePos.x);
  const auto nearest = std::ranges::min_element(over_time.windows, {}, [&](const OffsetWindow& window) {
    return std::abs(layout.x_px(window.time_s) - mouse_px);
  });
  const auto x = static_cast<float>(layout.x_px(nearest->time_s));
  ImGui::GetWindowDrawList()->AddLine({x, static_cast<float>(layout.plot.top)},
                                      {x, static_cast<float>(layout.plot.bottom())},
                                      to_imgui(context.style.faint_text, 0.6));
  ImGui::SetTooltip("%s", words_of(*nearest).c_str());
}

}  // namespace

bool has_windows(const PaneContext& context) {
  const Estimate* estimate = context.explorer.estimating.charted();
  return estimate != nullptr && estimate->over_time && !estimate->over_time->windows.empty();
}

void draw_over_time_strip(const PaneContext& context, const PixelRect& place) {
  const Estimate& estimate = *context.explorer.estimating.charted();
  const double scale = context.scale * 0.86;
  const Chart chart = over_time_chart(estimate, context.style).value();
  Drawing drawing;
  add_chart(drawing, place, chart, context.style, scale);
  paint(*ImGui::GetWindowDrawList(), drawing, context.fonts);
  const ChartLayout layout = lay_out_chart(chart, place, scale);
  invisible_button("over time", layout.plot);
  context.anchor("over time", layout.plot);
  if (ImGui::IsItemHovered()) show_window(context, *estimate.over_time, layout);
}

}  // namespace sweepscope::ui
