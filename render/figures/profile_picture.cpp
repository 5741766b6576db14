#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/charts/ticks.hpp"
#include "render/comparison/colouring.hpp"
#include "render/comparison/comparison_points.hpp"
#include "render/figures/figure_pictures.hpp"

namespace sweepscope {
namespace {

/// The section's outline, seen from above.
ScenePath outline_of(const CrossSection& section, Colour colour, double width_px) {
  ScenePath path{{}, width_px, colour};
  const Eigen::Vector3d across = section.reach_m * section.across(), middle = section.middle_m();
  const Eigen::Vector3d along = section.length_m / 2 * section.along();
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) {
    path.points_m.push_back(middle + a * across + b * along);
  }
  return path;
}

/// The map's points at the section's heights, coloured by which way the motor turned.
std::shared_ptr<const ColouredPoints> points_around(const ComparedMap& map, const CrossSection& section,
                                                    const Projection& projection) {
  SlabPoints points;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const MapPoint& point = (*map.cloud)[i];
    const auto z = static_cast<double>(point.z);
    if (z < section.from_m || z > section.to_m) continue;
    points.points.add({point.x, point.y, point.z}, static_cast<float>(point.sweep % 2));
    points.above_path_m.push_back(0);
  }
  return points_seen(points, projection, -1);
}

void add_scale_bar(Drawing& drawing, const Projection& projection, const Style& style, double scale) {
  const PixelRect& place = projection.place();
  const double length_m = round_length(projection.metres_per_px() * place.width * 0.3);
  const double length_px = length_m / projection.metres_per_px(), left = place.left + 10 * scale,
               bottom = place.bottom() - 10 * scale;
  drawing.fill({left, bottom - 2 * scale, length_px, 2 * scale}, style.map_highlight);
  drawing.add(
      TextMark{{left, bottom - 7 * scale},
               length_m >= 1 ? fmt::format("{:.0f} m", length_m) : fmt::format("{:.0f} cm", 100 * length_m),
               11 * scale,
               style.map_highlight});
}

void add_map_view(Page& page, const ComparedMap& map, const CrossSection& section, const Colouring& colouring,
                  const PixelRect& place, const std::string& label, Colour colour) {
  View view;
  view.place = place;
  const double extent_m = 2.6 * std::max(section.length_m, 2 * section.reach_m);
  view.scene.camera = camera_from_above(section.at_m, extent_m);
  view.scene.background = page.style.map_panel;
  view.scene.colours = colouring.scale;
  const Projection projection(view.scene.camera, place);
  view.scene.clouds.push_back({points_around(map, section, projection), 1.2 * page.scale});
  view.scene.paths.push_back(outline_of(section, page.style.map_highlight, 1.2 * page.scale));
  Drawing& marks = page.picture.marks;
  const double size = 12 * page.scale, chip = std::round(9 * page.scale);
  const double baseline = place.top - 7 * page.scale;
  marks.fill({place.left, std::round(baseline - chip), chip, chip}, colour);
  marks.add(TextMark{{place.left + chip + 6 * page.scale, baseline},
                     fit_text(label, size, place.width - 2 * chip, true),
                     size,
                     page.style.text,
                     AlignX::kLeft,
                     AlignY::kBaseline,
                     true});
  add_scale_bar(marks, projection, page.style, page.scale);
  marks.frame(place, page.scale, page.style.frame);
  page.picture.views.push_back(std::move(view));
}

Chart density_chart(std::span<const NamedProfile> profiles, const Style& style) {
  Chart chart;
  chart.title = "Density of points [1/mm]";
  chart.x_title = "distance across the face [mm]";
  chart.with_zero = true;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const auto& [name, profile] = profiles[i];
    ChartSeries series;
    series.name = name;
    series.colour = style.maps[i];
    series.marker = MarkerShape::kNone;
    series.filled = true;
    series.x = profile.distances_mm;
    series.y.assign(profile.density_per_mm.begin(), profile.density_per_mm.end());
    chart.series.push_back(std::move(series));
    if (!profile.width_at_half_height_mm) continue;
    const auto [from_mm, to_mm] = profile.half_height_mm;
    chart.spans.push_back({profile.peak_per_mm / 2, from_mm, to_mm,
                           fmt::format("{:.0f} mm", *profile.width_at_half_height_mm), style.maps[i]});
  }
  return chart;
}

}  // namespace

Picture profile_picture(std::span<const ComparedMap> maps, const CrossSection& section,
                        std::span<const NamedProfile> profiles, const ComparisonOptions& look) {
  constexpr double kNarrow = 0.6;  // of a column: letters stay legible on a phone
  const bool upright = look.height_px > look.width_px;
  Page page = make_page(look, upright ? kNarrow : 2);
  // By direction: a wrong offset puts the two to different sides of the face.
  const Colouring colouring = *make_colouring(ColourBy::kDirection, look.colour_table, {}, std::nullopt);
  const double label_room = std::round(24 * page.scale), gap = std::round(18 * page.scale);
  const auto count = static_cast<double>(maps.size());
  const double rows = upright ? std::ceil(count / 2) : std::min(count, 2.0),
               columns = std::ceil(count / rows);
  const double side =
      upright ? std::floor((page.room.width - gap) / 2)
              : std::floor(std::min((page.room.height - rows * label_room - (rows - 1) * gap) / rows,
                                    0.42 * page.room.width / columns));
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const auto line = static_cast<std::size_t>(upright ? columns : rows);
    const std::size_t line_number = i / line;
    const double across = static_cast<double>(i % line), along = static_cast<double>(line_number);
    const double row = upright ? along : across, column = upright ? across : along;
    const PixelRect place{page.room.left + column * (side + gap),
                          page.room.top + label_room + row * (side + label_room + gap), side, side};
    add_map_view(page, maps[i], section, colouring, place, profiles[i].name, page.style.maps[i]);
  }
  const double left = page.room.left + (upright ? 0 : columns * (side + gap) + gap);
  const double top = page.room.top + (upright ? rows * (side + label_room + gap) : 0);
  add_chart(page.picture.marks, {left, top, page.room.right() - left, page.room.bottom() - top},
            density_chart(profiles, page.style), page.style, page.scale);
  return std::move(page.picture);
}

}  // namespace sweepscope
