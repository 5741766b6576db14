#include "render/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr float kNoLimit_m = -std::numeric_limits<float>::infinity();

/// The maps as they are drawn: what is shown of them, by what camera and in what colours.
struct Prepared {
  std::vector<HeightRange> slabs;
  std::vector<SlabPoints> maps;
  ColourScale colours;
  std::vector<TopView> overviews, close_ups;
  float close_up_least_height_m = kNoLimit_m;  // above the path

  bool empty() const {
    return std::all_of(maps.begin(), maps.end(),
                       [](const SlabPoints& map) { return map.points.size() == 0; });
  }
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
  const double height_m = std::clamp(overview_m / 24, 2.0, 6.0);
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
  // A sparse floor behind a thin outline looks like the blur that the close-up is about.
  if (options.slabs.empty()) prepared.close_up_least_height_m = 0;
  return prepared;
}

/// The points inside a view and above a height over the path, no more of them than its pixels can show.
std::shared_ptr<const ColouredPoints> points_for(const SlabPoints& map, const TopView& view,
                                                 float least_height_m) {
  constexpr double kCellsPerPixel = 2;
  const Eigen::Vector2d half = view.half_extent_m();
  ColouredPoints inside;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const auto& point = map.points.xyz_m[i];
    if (std::abs(static_cast<double>(point[0]) - view.centre_m.x()) > half.x() ||
        std::abs(static_cast<double>(point[1]) - view.centre_m.y()) > half.y() ||
        map.above_path_m[i] < least_height_m) {
      continue;
    }
    inside.add(point, map.points.values[i]);
  }
  return std::make_shared<const ColouredPoints>(thin(inside, view.metres_per_px / kCellsPerPixel));
}

View to_view(const TopView& top, std::shared_ptr<const ColouredPoints> points, double point_size_px,
             const ColourScale& colours, const Style& style) {
  View view;
  view.place = top.place;
  view.scene.background = style.map_panel;
  view.scene.colours = colours;
  view.scene.camera = top.camera();
  view.scene.clouds.push_back({std::move(points), point_size_px});
  return view;
}

void add_map(Picture& picture, const ComparedMap& map, const Prepared& prepared, std::size_t index,
             const ComparisonLayout& layout, const Style& style) {
  const SlabPoints& points = prepared.maps[index];
  const TopView& overview = prepared.overviews[index];
  const double scale = layout.scale;
  const bool empty = points.points.size() == 0;
  picture.views.push_back(
      to_view(overview, points_for(points, overview, kNoLimit_m), scale, prepared.colours, style));
  add_overview_marks(picture.marks, overview, map.path, empty, style, scale);
  if (!prepared.close_ups.empty()) {
    const TopView& close_up = prepared.close_ups[index];
    auto near_points = points_for(points, close_up, prepared.close_up_least_height_m);
    picture.views.push_back(to_view(close_up, std::move(near_points), 1.5 * scale, prepared.colours, style));
    add_close_up_marks(picture.marks, overview, close_up, empty, style, scale);
  }
  add_label(picture.marks, layout.labels[index], overview.place.width, label_of(map), style.maps[index],
            style, scale);
  if (empty) add_no_points(picture.marks, map, overview, prepared.slabs, style, scale);
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
  for (std::size_t m = 0; m < maps.size(); ++m) add_map(picture, maps[m], *prepared, m, layout, style);
  const std::string title = !options.title.empty() ? options.title
                            : estimate != nullptr  ? estimate->recording
                                                   : "";
  const bool floor_left_out = !layout.close_ups.empty() && prepared->close_up_least_height_m == 0;
  std::string how = "Seen from above: " + describe_slabs(prepared->slabs) + ".";
  if (floor_left_out) how += " The close-ups leave out what is below.";
  add_heading(picture.marks, layout, title, how, options.width_px, style);
  if (!prepared->empty()) add_scalar_bar(picture.marks, layout, prepared->colours, style);
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
