#pragma once

#include "core/map/cross_section.hpp"
#include "render/charts/chart.hpp"
#include "ui/model/placed_cloud.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The box that the settings' profile line stands for: along it from end to end, 50 m round its middle at the
/// most, half a metre wide, of any height. Without a line: none.
std::optional<CrossSection> section_of(const Settings& settings);

/// The density of a pane's points along the line.
Profile profile_of(const PlacedCloud& cloud, const CrossSection& section);

/// Both densities in one chart, with their widths at half height in millimetres. Of a long line a chart's
/// worth of points, the densest of their neighbours.
Chart profile_chart(const Profile& a, const Profile& b, const Style& style);

}  // namespace sweepscope::ui
