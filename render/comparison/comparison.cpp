#include "render/comparison/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/charts/curve_charts.hpp"
#include "render/comparison/comparison_layout.hpp"
#include "render/comparison/comparison_marks.hpp"
#include "render/comparison/comparison_points.hpp"
#include "render/comparison/scene_depth.hpp"

namespace sweepscope {
namespace {

std::string label_of(const ComparedMap& map) {
  if (!map.label.empty()) return map.label;
  return map.offset_s ? fmt::format("offset {} ms", offset_label_ms(*map.offset_s)) : "";
}

std::string label_with_thickness(const ComparedMap& map) {
  if (!map.thickness || !map.thickness->map) return label_of(map);
  return fmt::format("{}   {:.0f} mm thick", label_of(map), map.thickness->map->median_m * 1e3);
}

constexpr float kNoLimit_m = -std::numeric_limits<float>::infinity();

/// The maps as they are drawn: what is shown of them, by what cameras and in what colours.
struct Prepared {
  std::vector<HeightRange> slabs;
  std::vector<SlabPoints> maps;
  Colouring colouring;
  std::vector<View> overviews, close_ups;      // without their points
  std::vector<Region> regions;                 // what each close-up shows
  float close_up_least_height_m = kNoLimit_m;  // above the path

  bool empty() const {
    return std::all_of(maps.begin(), maps.end(),
                       [](const SlabPoints& map) { return map.points.size() == 0; });
  }
};

Box box_of(std::span<const SlabPoints> maps) {
  constexpr double kOutermost = 0.001;  // stray points do not shrink the view
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Bounds bounds = bounds_of(maps, axis, kOutermost);
    box.from_m[static_cast<Eigen::Index>(axis)] = bounds.from;
    box.to_m[static_cast<Eigen::Index>(axis)] = bounds.to;
  }
  return box;
}

/// Long maps lie along the picture's width.
Camera camera_over(const Box& box, const PixelRect& place) {
  constexpr double kRoom = 1.06;
  const double x_m = box.to_m.x() - box.from_m.x(), y_m = box.to_m.y() - box.from_m.y();
  const bool turned = y_m > 1.2 * x_m;
  const double across_m = turned ? y_m : x_m, down_m = turned ? x_m : y_m;
  const double metres_per_px =
      std::max({kRoom * across_m / place.width, kRoom * down_m / place.height, 1e-4});
  return camera_from_above(box.middle_m().head<2>(), metres_per_px * place.height, turned);
}

Camera overview_camera(std::span<const SlabPoints> shown, const PixelRect& place,
                       const ComparisonOptions& options) {
  if (options.camera) {
    Camera camera = *options.camera;
    camera.orthographic = !options.perspective;
    return camera;
  }
  const Box box = options.box ? *options.box : box_of(shown);
  if (options.viewpoint == Viewpoint::kTop && !options.perspective) return camera_over(box, place);
  return camera_on(box, options.viewpoint, !options.perspective, place.width / place.height);
}

bool is_turned(const Camera& camera) {
  return camera.up.x() < -0.5;
}

std::vector<View> overviews_of(const Prepared& prepared, const ComparisonLayout& layout,
                               const ComparisonOptions& options) {
  std::vector<View> views;
  for (std::size_t m = 0; m < layout.overviews.size(); ++m) {
    View& view = views.emplace_back();
    view.place = layout.overviews[m];
    if (m > 0 && !options.each_own_view) {
      view.scene.camera = views[0].scene.camera;
      continue;
    }
    const std::span<const SlabPoints> all(prepared.maps);
    view.scene.camera = overview_camera(options.each_own_view ? all.subspan(m, 1) : all, view.place, options);
  }
  return views;
}

/// The extent of what a view shows.
double extent_m(const View& view) {
  return Projection(view.scene.camera, view.place).metres_per_px() *
         std::max(view.place.width, view.place.height);
}

Region close_up_region(const Prepared& prepared, const View& overview, double aspect,
                       const ComparisonOptions& options) {
  if (options.close_up) return *options.close_up;
  const double height_m = close_up_height_m(extent_m(overview));
  return find_close_up(prepared.maps, height_m, height_m * aspect);
}

void add_close_ups(Prepared& prepared, const ComparisonLayout& layout, const ComparisonOptions& options) {
  if (layout.close_ups.empty()) return;
  const PixelRect& first = layout.close_ups[0];
  const Region region = close_up_region(prepared, prepared.overviews[0], first.width / first.height, options);
  const bool turned = is_turned(prepared.overviews[0].scene.camera);
  for (const PixelRect& place : layout.close_ups) {
    View& view = prepared.close_ups.emplace_back();
    view.place = place;
    view.scene.camera = camera_from_above(region.centre_m, region.height_m, turned);
    prepared.regions.push_back(region);
  }
}

Result<std::vector<std::vector<float>>> values_of(std::span<const ComparedMap> maps, ColourBy by) {
  std::vector<std::vector<float>> values;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    // The first map is compared with the second, and the others with the first.
    const ComparedMap* other = maps.size() < 2 ? nullptr : &maps[m == 0 ? 1 : 0];
    auto of_map = colour_values(maps[m], other, by);
    if (!of_map) return tl::unexpected(of_map.error());
    values.push_back(std::move(*of_map));
  }
  return values;
}

Result<Prepared> prepare(std::span<const ComparedMap> maps, const ComparisonLayout& layout,
                         const ComparisonOptions& options) {
  const auto values = values_of(maps, options.colour_by);
  if (!values) return tl::unexpected(values.error());
  Prepared prepared;
  prepared.slabs = choose_slabs(maps, options);
  std::vector<std::span<const float>> shown;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    prepared.maps.push_back(points_in_slabs(maps[m], (*values)[m], prepared.slabs, options.box));
  }
  for (const SlabPoints& map : prepared.maps) shown.push_back(map.points.values);
  auto colouring = make_colouring(options.colour_by, options.colour_table, shown, options.colour_range);
  if (!colouring) return tl::unexpected(colouring.error());
  prepared.colouring = std::move(*colouring);
  prepared.overviews = overviews_of(prepared, layout, options);
  add_close_ups(prepared, layout, options);
  // A sparse floor behind a thin outline looks like the blur that the close-up is about.
  if (options.slabs.empty()) prepared.close_up_least_height_m = 0;
  return prepared;
}

/// What a panel of a map needs besides its points.
struct Panel {
  const Prepared& prepared;
  const ComparisonLayout& layout;
  const ComparisonOptions& options;
  const Style& style;
};

View with_points(View view, const Panel& panel, const SlabPoints& map, float min_height_m,
                 double point_size_px) {
  const Projection projection(view.scene.camera, view.place);
  view.scene.background = panel.style.map_panel;
  view.scene.colours = panel.prepared.colouring.scale;
  view.scene.clouds.push_back({points_seen(map, projection, min_height_m),
                               point_size_px * panel.options.point_size_px * panel.layout.scale});
  return view;
}

Box box_shown(const Panel& panel) {
  return panel.options.box ? *panel.options.box : box_of(panel.prepared.maps);
}

ScenePath sensor_path(std::span<const StampedPose> poses, const Panel& panel) {
  ScenePath path{{}, 1.2 * panel.layout.scale, panel.style.map_highlight};
  path.colour.alpha = 120;
  for (const StampedPose& pose : poses) path.points_m.push_back(pose.position_m);
  return path;
}

double path_height_m(const ComparedMap& map) {
  if (map.path.empty()) return map.path_height_m;
  double sum = 0;
  for (const StampedPose& pose : map.path) sum += pose.position_m.z();
  return sum / static_cast<double>(map.path.size());
}

/// What a close-up shows, as a frame at the path's height.
ScenePath outline(const View& close_up, double height_m, const Panel& panel) {
  const double half_y = close_up.scene.camera.view_height_m / 2,
               half_x = half_y * close_up.place.width / close_up.place.height;
  const bool turned = is_turned(close_up.scene.camera);
  const Eigen::Vector2d half = turned ? Eigen::Vector2d(half_y, half_x) : Eigen::Vector2d(half_x, half_y);
  const Eigen::Vector2d middle = close_up.scene.camera.looks_at_m.head<2>();
  ScenePath path{{}, 1.5 * panel.layout.scale, panel.style.map_highlight};
  for (const auto& [sx, sy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) {
    path.points_m.emplace_back(middle.x() + sx * half.x(), middle.y() + sy * half.y(), height_m);
  }
  return path;
}

void add_map(Picture& picture, const ComparedMap& map, std::size_t index, const Panel& panel) {
  const auto& [prepared, layout, options, style] = panel;
  const SlabPoints& points = prepared.maps[index];
  const double scale = layout.scale;
  const bool empty = points.points.size() == 0;
  const PixelRect& place = prepared.overviews[index].place;
  add_label(picture.marks, layout.labels[index], place.width,
            options.colour_by == ColourBy::kBlur ? label_with_thickness(map) : label_of(map),
            style.maps[index], style, scale);
  if (empty) {
    add_no_points(picture.marks, map, place, prepared.slabs, style, scale);
    if (!prepared.close_ups.empty()) picture.marks.frame(prepared.close_ups[index].place, scale, style.frame);
    return;
  }
  View overview = with_points(prepared.overviews[index], panel, points, kNoLimit_m, 1);
  overview.scene.paths.push_back(sensor_path(map.path, panel));
  overview = with_depth(std::move(overview), {options.cues, box_shown(panel), map.scanner, scale}, style);
  const Projection projection(overview.scene.camera, overview.place);
  add_overview_marks(picture.marks, projection, overview.scene.camera, style, scale);
  if (!prepared.close_ups.empty()) {
    View close_up =
        with_points(prepared.close_ups[index], panel, points, prepared.close_up_least_height_m, 1.5);
    overview.scene.paths.push_back(outline(close_up, path_height_m(map), panel));
    add_close_up_marks(picture.marks, Projection(close_up.scene.camera, close_up.place), style, scale);
    picture.views.push_back(std::move(close_up));
  }
  picture.views.push_back(std::move(overview));
}

Result<void> check(std::span<const ComparedMap> maps, const ComparisonOptions& options) {
  if (maps.empty() || maps.size() > kDarkStyle.maps.size()) {
    return failure(ExitCode::kWrongUsage, fmt::format("A comparison shows 1 to {} maps, not {}",
                                                      kDarkStyle.maps.size(), maps.size()));
  }
  return check_size(options);
}

void add_charts(Picture& picture, std::span<const Chart> charts, const Estimate& estimate,
                const ComparisonLayout& layout, const Style& style) {
  if (charts.empty()) add_no_curve(picture.marks, layout.charts[0], estimate, style, layout.scale);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    add_chart(picture.marks, layout.charts[c], charts[c], style, layout.scale);
  }
}

/// Where there is an estimate without curves, a text takes a chart's place.
std::size_t places_of_charts(const Estimate* estimate, std::size_t charts) {
  return estimate == nullptr ? 0 : std::max<std::size_t>(1, charts);
}

std::string seen_from(const ComparisonOptions& options) {
  const std::string how = options.perspective ? " in perspective" : "";
  if (options.camera) return "Seen from a given camera" + how;
  if (options.viewpoint == Viewpoint::kTop) return "Seen from above" + how;
  if (options.viewpoint == Viewpoint::kFront) return "Seen along y" + how;
  if (options.viewpoint == Viewpoint::kRight) return "Seen along -x" + how;
  return options.perspective ? "Oblique view in perspective" : "Isometric view";
}

std::string how_it_is_seen(const Prepared& prepared, const ComparisonOptions& options) {
  std::string how = seen_from(options) + ": " + describe_slabs(prepared.slabs) + ".";
  const bool floor_left_out = !prepared.close_ups.empty() && prepared.close_up_least_height_m == 0;
  if (options.box) how += " Only a box of the map is shown.";
  if (floor_left_out) how += " The close-ups leave out what is below.";
  return how;
}

}  // namespace

Result<void> check_size(const ComparisonOptions& options) {
  if (options.width_px < 640 || options.height_px < 400) {
    return failure(ExitCode::kWrongUsage,
                   fmt::format("A comparison of {} x {} pixels is too small: 640 x 400 at least",
                               options.width_px, options.height_px));
  }
  return {};
}

Result<Picture> comparison_picture(std::span<const ComparedMap> given, const Estimate* estimate,
                                   const ComparisonOptions& options) {
  if (auto usable = check(given, options); !usable) return tl::unexpected(usable.error());
  std::vector<ComparedMap> maps(given.begin(), given.end());
  if (options.colour_by == ColourBy::kBlur)
    for (ComparedMap& map : maps) measure_thickness(map);
  const Style style = style_of(options.background);
  std::vector<MarkedOffset> marked;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    if (maps[m].offset_s) marked.push_back({*maps[m].offset_s, style.maps[m]});
  }
  const auto charts = estimate != nullptr ? curve_charts(*estimate, marked, style) : std::vector<Chart>{};
  const ComparisonLayout layout = lay_out(options, maps.size(), places_of_charts(estimate, charts.size()));
  const auto prepared = prepare(maps, layout, options);
  if (!prepared) return tl::unexpected(prepared.error());

  Picture picture{options.width_px, options.height_px, style.page, {}, {}};
  const Panel panel{*prepared, layout, options, style};
  for (std::size_t m = 0; m < maps.size(); ++m) add_map(picture, maps[m], m, panel);
  const std::string title =
      options.title.empty() && estimate != nullptr ? estimate->recording : options.title;
  add_heading(picture.marks, layout, title, how_it_is_seen(*prepared, options), options.width_px, style);
  if (!prepared->empty()) add_legend(picture.marks, layout, prepared->colouring, style);
  if (estimate != nullptr) add_charts(picture, charts, *estimate, layout, style);
  add_footer(picture.marks, layout, options.width_px, style);
  return picture;
}

Result<std::vector<DifferingPlace>> differing_places(std::span<const ComparedMap> maps,
                                                     const Estimate* estimate,
                                                     const ComparisonOptions& options) {
  constexpr std::size_t kMaxPlaces = 12;
  if (auto usable = check(maps, options); !usable) return tl::unexpected(usable.error());
  ComparisonOptions with_close_up = options;
  with_close_up.with_close_up = true;
  const std::size_t charts =
      estimate != nullptr ? curve_charts(*estimate, {}, style_of(options.background)).size() : 0;
  const ComparisonLayout layout = lay_out(with_close_up, maps.size(), places_of_charts(estimate, charts));
  Prepared prepared;
  prepared.slabs = choose_slabs(maps, options);
  for (const ComparedMap& map : maps) {
    const std::vector<float> no_values(map.size());
    prepared.maps.push_back(points_in_slabs(map, no_values, prepared.slabs, options.box));
  }
  const double height_m = close_up_height_m(extent_m(overviews_of(prepared, layout, options).front()));
  const PixelRect& place = layout.close_ups.front();
  return differing_places(prepared.maps, height_m, height_m * place.width / place.height, kMaxPlaces);
}

std::vector<PngText> comparison_texts(std::span<const ComparedMap> maps, const ComparisonOptions& options) {
  std::string labels;
  for (const ComparedMap& map : maps) labels += (labels.empty() ? "" : "; ") + label_of(map);
  std::string thickness;
  for (const ComparedMap& map : maps) {
    if (map.thickness && map.thickness->map) thickness += (thickness.empty() ? "" : "; ") + in_words(map);
  }
  std::vector<PngText> texts{
      {"Software", "sweepscope " SWEEPSCOPE_VERSION},
      {"Equation", "t_motor = t_laser + offset"},
      {"Maps", labels},
      {"Recipe",
       fmt::format("compare, {} x {}, by {}, {}", options.width_px, options.height_px,
                   colour_by_names()[static_cast<std::size_t>(options.colour_by)], options.colour_table)}};
  if (!thickness.empty()) texts.push_back({"Thickness", thickness});
  return texts;
}

}  // namespace sweepscope
