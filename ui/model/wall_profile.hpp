#pragma once

#include "core/map/sections/cross_section.hpp"
#include "render/charts/chart.hpp"
#include "ui/model/placed_cloud.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The box of the settings' profile line: along the line, at most 50 m about its middle, half a metre wide,
/// of any height. Absent without a line.
std::optional<CrossSection> section_of(const Settings& settings);

/// The density of a pane's points along the line.
Profile profile_of(const PlacedCloud& cloud, const CrossSection& section);

/// Both densities in one chart over the line, from its first end, with their widths at half height in
/// millimetres. A long line is reduced to the resolution of the chart, with the highest density of each
/// group. `of`: what the points are, if they are not all of a finished map: "thinned points"; else empty.
Chart profile_chart(const Profile& a, const Profile& b, const Settings& settings, const std::string& of,
                    const Style& style);

}  // namespace sweepscope::ui
