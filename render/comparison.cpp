#include "render/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/comparison_layout.hpp"
#include "render/comparison_marks.hpp"
#include "render/comparison_points.hpp"
#include "render/curve_charts.hpp"
#include "render/picture.hpp"
#include "render/top_view.hpp"

namespace sweepscope {
namespace {

std::string label_of(const ComparedMap& map) {
  if (!map.label.empty()) return map.label;
  return map.offset_s ? fmt::format("offset {} ms", offset_label_ms(*map.offset_s)) : "";
}

/// The maps as they are drawn: what is shown of them, by what camera and in what colours.
struct Prepared {
  std::vector<HeightRange> slabs;
  std::vector<SlabPoints> maps;
  ColourScale colours;
  std::vector<TopView> overviews, close_ups;
};

std::vector<TopView> overviews_of(const Prepared& prepared, const ComparisonLayout& layout) {
  constexpr double kOutermost = 0.001, kRoom = 1.06;  // stray points do not shrink the view
  const Bounds x = bounds_of(prepared.maps, 0, kOutermost), y = bounds_of(prepared.maps, 1, kOutermost);
  TopView view;
  view.turned = y.length() > 1.2 * x.length();
  view.centre_m = {x.middle(), y.middle()};
  const double across_m = view.turned ? y.length() : x.length(),
               down_m = view.turned ? x.length() : y.length();
  std::vector<TopView> views;
  for (const PixelRect& place : layout.overviews) {
    view.place = place;
    view.metres_per_px = std::max({kRoom * across_m / place.width, kRoom * down_m / place.height, 1e-4});
    views.push_back(view);
  }
  return views;
}

std::vector<TopView> close_ups_of(const Prepared& prepared, const ComparisonLayout& layout,
                                  const ComparisonOptions& options) {
  if (layout.close_ups.empty()) return {};
  const TopView& overview = prepared.overviews[0];
  const PixelRect& first = layout.close_ups[0];
  const double overview_m = overview.metres_per_px * std::max(overview.place.width, overview.place.height);
  const double height_m = std::clamp(overview_m / 14, 2.0, 10.0);
  const Region region = options.close_up
                            ? *options.close_up
                            : find_close_up(prepared.maps, height_m, height_m * first.width / first.height);
  std::vector<TopView> views;
  for (const PixelRect& place : layout.close_ups) {
    views.push_back({place, region.centre_m, region.height_m / place.height, overview.turned});
  }
  return views;
}

Result<Prepared> prepare(std::span<const ComparedMap> maps, const ComparisonLayout& layout,
                         const ComparisonOptions& options) {
  const auto table = colour_table(options.colour_table);
  if (!table) return tl::unexpected(table.error());
  Prepared prepared;
  prepared.slabs = choose_slabs(maps, options);
  for (const ComparedMap& map : maps) prepared.maps.push_back(points_in_slabs(map, prepared.slabs));
  const Bounds z = bounds_of(prepared.maps, 2, 0.005);
  prepared.colours = {*table, z.from, z.to};
  prepared.overviews = overviews_of(prepared, layout);
  prepared.close_ups = close_ups_of(prepared, layout, options);
  return prepared;
}

/// The points inside a view, no more of them than its pixels can show.
std::shared_ptr<const ColouredPoints> points_for(const SlabPoints& map, const TopView& view) {
  constexpr double kCellsPerPixel = 2;
  const Eigen::Vector2d half = view.half_extent_m();
  ColouredPoints inside;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const auto& point = map.points.xyz_m[i];
    if (std::abs(static_cast<double>(point[0]) - view.centre_m.x()) > half.x() ||
        std::abs(static_cast<double>(point[1]) - view.centre_m.y()) > half.y()) {
      continue;
    }
    inside.add(point, map.points.values[i]);
  }
  return std::make_shared<const ColouredPoints>(thin(inside, view.metres_per_px / kCellsPerPixel));
}

View to_view(const SlabPoints& map, const TopView& top, const ColourScale& colours, double point_size_px,
             const Style& style) {
  View view;
  view.place = top.place;
  view.scene.background = style.panel;
  view.scene.colours = colours;
  view.scene.camera = top.camera();
  view.scene.clouds.push_back({points_for(map, top), point_size_px});
  return view;
}

void add_maps(Picture& picture, std::span<const ComparedMap> maps, const Prepared& prepared,
              const ComparisonLayout& layout, const Style& style) {
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const TopView& overview = prepared.overviews[m];
    const bool empty = prepared.maps[m].points.size() == 0;
    picture.views.push_back(to_view(prepared.maps[m], overview, prepared.colours, layout.scale, style));
    if (!prepared.close_ups.empty()) {
      const TopView& close_up = prepared.close_ups[m];
      picture.views.push_back(
          to_view(prepared.maps[m], close_up, prepared.colours, 1.5 * layout.scale, style));
      add_close_up_marks(picture.marks, overview, close_up, empty, style, layout.scale);
    }
    add_overview_marks(picture.marks, overview, style, layout.scale);
    add_label(picture.marks, layout.labels[m], overview.place.width, label_of(maps[m]), style.maps[m], style,
              layout.scale);
    if (empty) add_no_points(picture.marks, maps[m], overview, prepared.slabs, style, layout.scale);
  }
}

Result<void> check(std::span<const ComparedMap> maps, const ComparisonOptions& options) {
  if (maps.size() < 1 || maps.size() > kDarkStyle.maps.size()) {
    return failure(ExitCode::kWrongUsage, fmt::format("A comparison shows 1 to {} maps, not {}",
                                                      kDarkStyle.maps.size(), maps.size()));
  }
  if (options.width_px < 640 || options.height_px < 400) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("A comparison of {} x {} pixels is too small: 640 x 400 at least",
                               options.width_px, options.height_px));
  }
  return {};
}

}  // namespace

Result<Image> draw_comparison(std::span<const ComparedMap> maps, const Estimate* estimate,
                              const ComparisonOptions& options) {
  if (auto usable = check(maps, options); !usable) return tl::unexpected(usable.error());
  const Style& style = options.light_background ? kLightStyle : kDarkStyle;
  std::vector<MarkedOffset> marked;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    if (maps[m].offset_s) marked.push_back({*maps[m].offset_s, style.maps[m]});
  }
  const auto charts = estimate != nullptr ? curve_charts(*estimate, marked, style) : std::vector<Chart>{};
  const bool no_curve = estimate != nullptr && charts.empty();
  const ComparisonLayout layout = lay_out(options, maps.size(), no_curve ? 1 : charts.size());
  const auto prepared = prepare(maps, layout, options);
  if (!prepared) return tl::unexpected(prepared.error());

  Picture picture{options.width_px, options.height_px, style.page, {}, {}};
  add_maps(picture, maps, *prepared, layout, style);
  const std::string title = !options.title.empty() ? options.title
                            : estimate != nullptr  ? estimate->recording
                                                   : "";
  add_heading(picture.marks, layout, title, prepared->slabs, options.width_px, style);
  add_scalar_bar(picture.marks, layout, prepared->colours, style);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    add_chart(picture.marks, layout.charts[c], charts[c], style, layout.scale);
  }
  if (no_curve) add_no_curve(picture.marks, layout.charts[0], *estimate, style, layout.scale);
  add_footer(picture.marks, layout, options.width_px, style);
  return draw(picture);
}

Result<void> write_comparison(const std::filesystem::path& path, std::span<const ComparedMap> maps,
                              const Estimate* estimate, const ComparisonOptions& options) {
  return draw_comparison(maps, estimate, options).and_then([&](const Image& image) {
    std::string labels;
    for (const ComparedMap& map : maps) labels += (labels.empty() ? "" : "; ") + label_of(map);
    const std::vector<PngText> texts{{"Software", "sweepscope " SWEEPSCOPE_VERSION},
                                     {"Equation", "t_motor = t_laser + offset"},
                                     {"Maps", labels},
                                     {"Recipe", fmt::format("compare, {} x {}, {}", options.width_px,
                                                            options.height_px, options.colour_table)}};
    return write_png(image, path, texts);
  });
}

}  // namespace sweepscope
