#pragma once

#include "render/charts/chart_layout.hpp"
#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// The grip at the foot of a handle's line.
PixelRect grip_of(const ChartLayout& layout, double at_ms, double scale);

/// The handle that the mouse takes hold of: the one whose grip it is on, that of the map `top` first, or the
/// nearest line within reach; none beside them.
std::optional<Side> handle_under(const ChartLayout& layout, const Settings& settings, Side top,
                                 PixelPoint mouse, double scale);

/// The range of offsets after a zoom by `factor` (above 1: closer) about one of them; at least 0.1 ms, and
/// empty where it holds all there is.
std::optional<AxisRange> zoomed_range(const AxisRange& shown, double factor, double about,
                                      const AxisRange& all);

/// Handles to drag, the wheel, drags beside the handles, double clicks, and the values under the mouse.
/// `all`: the axis where no part of it is chosen.
void use_chart_mouse(const PaneContext& context, const Chart& chart, const ChartLayout& layout,
                     const AxisRange& all, std::size_t number);

}  // namespace sweepscope::ui
