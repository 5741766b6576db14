#include "ui/model/wall_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sweepscope::ui {
namespace {

constexpr double kMaxReach_m = 25;       // a wall is asked for, not a town
constexpr std::size_t kMaxDrawn = 2000;  // more than a chart is pixels wide

/// `middle_mm`: of the line, from its first end.
void add(Chart& chart, const Profile& profile, double middle_mm, const char* name, Colour colour) {
  ChartSeries series;
  series.name = name;
  series.colour = colour;
  series.marker = MarkerShape::kNone;
  series.filled = true;
  const auto& densities = profile.density_per_mm;
  const std::size_t stride = densities.size() / kMaxDrawn + 1;
  for (std::size_t i = 0; i < densities.size(); i += stride) {
    const auto first = densities.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = densities.begin() + static_cast<std::ptrdiff_t>(std::min(i + stride, densities.size()));
    const auto densest = std::max_element(first, last);  // peaks stay as high as they are
    const double at_mm = profile.distances_mm[static_cast<std::size_t>(densest - densities.begin())] +
                         profile.median_mm + middle_mm;
    if (!chart.x_range->contains(at_mm)) continue;
    series.x.push_back(at_mm);
    series.y.emplace_back(*densest);
  }
  chart.series.push_back(std::move(series));
  if (!profile.width_at_half_height_mm) return;
  const double median_mm = profile.median_mm + middle_mm;
  const auto [from_mm, to_mm] = profile.half_height_mm;
  chart.spans.push_back({profile.peak_per_mm / 2, from_mm + median_mm, to_mm + median_mm,
                         fmt::format("{:.0f} mm", *profile.width_at_half_height_mm), colour});
}

}  // namespace

std::optional<CrossSection> section_of(const Settings& settings) {
  const Eigen::Vector2d along_m = settings.profile_to_m - settings.profile_from_m;
  if (along_m.norm() < 1e-3) return std::nullopt;
  CrossSection section;
  section.at_m = (settings.profile_from_m + settings.profile_to_m) / 2;
  section.normal_rad = std::atan2(along_m.y(), along_m.x());
  section.length_m = 0.5;
  section.from_m = -100;
  section.to_m = 100;
  section.reach_m = std::min(along_m.norm() / 2, kMaxReach_m);
  return section;
}

Profile profile_of(const PlacedCloud& cloud, const CrossSection& section) {
  const Eigen::Vector2d across(std::cos(section.normal_rad), std::sin(section.normal_rad));
  const double reach_m = std::hypot(section.reach_m, section.length_m);
  MapCloud near;  // the others would only be copied
  for (const auto& p : cloud.points->xyz_m) {
    const Eigen::Vector2d from_middle_m =
        Eigen::Vector2d(static_cast<double>(p[0]), static_cast<double>(p[1])) - section.at_m;
    if (std::abs(from_middle_m.dot(across)) > reach_m || from_middle_m.norm() > 2 * reach_m) continue;
    MapPoint point{};
    point.x = p[0];
    point.y = p[1];
    point.z = p[2];
    near.push_back(point);
  }
  return profile_across(near, section);
}

Chart profile_chart(const Profile& a, const Profile& b, const Settings& settings, const std::string& of,
                    const Style& style) {
  const double length_mm = 1e3 * (settings.profile_to_m - settings.profile_from_m).norm();
  const double reach_mm = std::min(length_mm / 2, 1e3 * kMaxReach_m);
  Chart chart;
  chart.title = of.empty() ? "Profile: density of points [1/mm]"
                           : fmt::format("Profile of {} so far: density [1/mm]", of);
  chart.x_title = "along the line, from its first end [mm]";
  chart.with_zero = true;
  chart.x_range = AxisRange{length_mm / 2 - reach_mm, length_mm / 2 + reach_mm};
  add(chart, a, length_mm / 2, "A", style.maps[0]);
  add(chart, b, length_mm / 2, "B", style.maps[1]);
  return chart;
}

}  // namespace sweepscope::ui
