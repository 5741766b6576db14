#include "ui/explorer/maps_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "render/charts/curve_charts.hpp"
#include "render/comparison/comparison_layout.hpp"
#include "render/comparison/comparison_marks.hpp"
#include "render/comparison/look_options.hpp"
#include "render/comparison/scanner_pose.hpp"
#include "render/comparison/scene_depth.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/model/playback.hpp"
#include "ui/model/view_camera.hpp"

namespace sweepscope::ui {
namespace {

/// The colours of points that are placed, as a table with their numbers in it.
struct Coloured {
  std::shared_ptr<ColouredPoints> points = std::make_shared<ColouredPoints>();
  ColourScale scale;
};

Coloured coloured(const LivePoints& live) {
  Coloured out;
  out.scale.from = 0;
  out.scale.to = 255;
  std::map<std::array<std::uint8_t, 3>, float> known;
  for (std::size_t i = 0; i < live.size(); ++i) {
    const auto& rgb = live.rgb[i];
    // A table's 256 colours and the grey of points without a value: the last of more share a number.
    const auto next = static_cast<float>(std::min<std::size_t>(known.size(), 255));
    const auto [found, is_new] = known.try_emplace(rgb, next);
    if (is_new) out.scale.table[static_cast<std::size_t>(next)] = {rgb[0], rgb[1], rgb[2]};
    out.points->add(live.xyz_m[i], found->second);
  }
  return out;
}

sweepscope::Background background_of(const Settings& s) {
  const bool light = s.theme == Theme::kLight && s.backdrop == Backdrop::kTheme;
  if (light || s.backdrop == Backdrop::kWhite) return sweepscope::Background::kWhite;  // as in the panes
  return s.theme == Theme::kLight ? sweepscope::Background::kLight : sweepscope::Background::kDark;
}

Camera camera_for(const ViewPoint& view, bool perspective, double pane_aspect, const PixelRect& place) {
  ViewPoint whole = view;
  whole.height_m *= std::max(1.0, pane_aspect * place.height / place.width);
  return camera_of(whole, perspective);
}

View view_of(const Explorer& explorer, Side side, const PixelRect& place, double pane_aspect,
             const ComparisonLayout& layout, const Style& style) {
  const Settings& s = explorer.settings();
  const Pane& pane = explorer.pane(side);
  const Placement& placement = pane.request->placement;
  const Coloured points = coloured(*(pane.full ? pane.full : pane.coarse)->points);
  View view{place, {}};
  Scene& scene = view.scene;
  // A view that nobody moved shows the whole map, without room for a close-up in its corner.
  const auto extent = explorer.maps.extent_in_view(s.heights);
  const ViewPoint& seen = side == Side::kA ? s.camera_a : s.camera_b;
  const double aspect = place.width / place.height;
  scene.camera = explorer.view.moved_by_person || s.has_box() || !extent
                     ? camera_for(seen, s.perspective, pane_aspect, place)
                     : camera_of(fitted(seen, *extent, {aspect, 0, 0}, s.perspective), s.perspective);
  scene.background = style.map_panel;
  scene.colours = points.scale;
  scene.clouds.push_back({points.points, std::max(0.5, s.point_size_px / 2) * layout.scale});
  if (s.trajectory) {
    ScenePath path{{}, 1.2 * layout.scale, style.map_highlight};
    path.colour.alpha = 120;
    for (const StampedPose& pose : placement.map->trajectory) path.points_m.push_back(pose.position_m);
    scene.paths.push_back(std::move(path));
  }
  const Recording& recording = placement.loaded->recording;
  const double until_s = scanner_time_s(recording, s);
  const SolvedMap& map = *placement.map;
  return with_depth(std::move(view),
                    {s.cues, map.main_box,
                     scanner_pose(recording, map.trajectory, placement.offset_s, until_s), layout.scale},
                    style);
}

/// The close-up of a map, as large as fits into the middle of its place.
View close_up_of(const Explorer& explorer, Side side, const PixelRect& room, const ComparisonLayout& layout,
                 const Style& style) {
  const PlaceToLook& shown = *explorer.place();
  const double width = std::min(room.width, room.height * PlaceToLook::kAspect),
               height = width / PlaceToLook::kAspect;
  View view{{std::round(room.left + (room.width - width) / 2),
             std::round(room.top + (room.height - height) / 2), std::round(width), std::round(height)},
            {}};
  const Coloured points = coloured(*explorer.pane(side).close_up->points);
  view.scene.camera = camera_of(shown.view(), false);
  view.scene.background = style.map_panel;
  view.scene.colours = points.scale;
  view.scene.clouds.push_back(
      {points.points, 1.5 * std::max(0.5, explorer.settings().point_size_px / 2) * layout.scale});
  return view;
}

/// What the close-up shows, on the map.
ScenePath outline_of(const PlaceToLook& place, const ComparisonLayout& layout, const Style& style) {
  ScenePath path{{}, 1.5 * layout.scale, style.map_highlight};
  const Eigen::Vector2d& centre_m = place.found.region.centre_m;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}})
    path.points_m.emplace_back(centre_m.x() + x * place.width_m() / 2,
                               centre_m.y() + y * place.height_m() / 2, place.z_m);
  return path;
}

constexpr std::array<std::pair<const char*, bool FigureParts::*>, 4> kParts{
    {{"offsets", &FigureParts::offsets},
     {"legend", &FigureParts::legend},
     {"scale", &FigureParts::scale},
     {"close-up", &FigureParts::close_up}}};

}  // namespace

Result<FigureParts> parse_figure_parts(const std::string& words) {
  FigureParts parts{false, false, false, false};
  std::istringstream list(words == "none" ? "" : words);
  for (std::string word; std::getline(list, word, ',');) {
    const auto part = std::ranges::find_if(kParts, [&](const auto& known) { return known.first == word; });
    if (part == kParts.end())
      return not_now(
          fmt::format("{}: a figure has the parts offsets, legend, scale and close-up, or none", word));
    parts.*(part->second) = true;
  }
  return parts;
}

std::string to_words(const FigureParts& parts) {
  std::string words;
  for (const auto& [word, member] : kParts)
    if (parts.*member) words += (words.empty() ? "" : ",") + std::string(word);
  return words.empty() ? "none" : words;
}

Result<std::pair<int, int>> parse_figure_size(const std::string& size) {
  ComparisonOptions options;
  return set_look(options, *find_look_option("size"), size)
      .and_then([&] { return check_size(options); })
      .map([&] {
        return std::pair{options.width_px, options.height_px};
      });
}

Result<Picture> maps_picture(const Explorer& explorer, int width_px, int height_px, double pane_aspect,
                             const FigureParts& parts) {
  const Settings& s = explorer.settings();
  ComparisonOptions options;
  options.width_px = width_px;
  options.height_px = height_px;
  const auto has_close_up = [&](Side side) { return explorer.pane(side).close_up != nullptr; };
  const std::vector<Side> sides = sides_of(s.layout);
  options.with_close_up =
      parts.close_up && explorer.place() != nullptr && std::ranges::all_of(sides, has_close_up);
  options.background = background_of(s);
  if (auto usable = check_size(options); !usable) return tl::unexpected(usable.error());
  const bool difference = s.layout == Layout::kDifference;
  const ColourSpan span = explorer.maps.shown_span();
  const std::vector<float> no_values;
  const std::array none{std::span<const float>(no_values)};
  auto colouring = make_colouring(difference ? ColourBy::kDistance : s.colouring, s.table, none,
                                  ValueRange{span.from, span.to});
  if (!colouring) return tl::unexpected(colouring.error());
  const Style style = style_of(options.background);
  const ComparisonLayout layout = lay_out(options, sides.size(), 0);
  Picture picture{width_px, height_px, style.page, {}, {}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Pane& pane = explorer.pane(sides[i]);
    if (!pane.request || (!pane.full && !pane.coarse)) continue;
    const bool a = sides[i] == Side::kA;
    if (parts.offsets)
      add_label(
          picture.marks, layout.labels[i], layout.overviews[i].width,
          fmt::format("{}  offset {} ms", a ? "A" : "B", offset_label_ms(pane.request->placement.offset_s)),
          style.maps[a ? 0 : 1], style, layout.scale);
    View view = view_of(explorer, sides[i], layout.overviews[i], pane_aspect, layout, style);
    if (parts.scale)
      add_overview_marks(picture.marks, Projection(view.scene.camera, view.place), view.scene.camera, style,
                         layout.scale);
    else
      picture.marks.frame(view.place, layout.scale, style.frame);
    if (options.with_close_up) {
      view.scene.paths.push_back(outline_of(*explorer.place(), layout, style));
      picture.views.push_back(close_up_of(explorer, sides[i], layout.close_ups[i], layout, style));
      const View& close_up = picture.views.back();
      if (parts.scale)
        add_close_up_marks(picture.marks, Projection(close_up.scene.camera, close_up.place), style,
                           layout.scale);
      else
        picture.marks.frame(close_up.place, 1.5 * layout.scale, style.highlight);
    }
    picture.views.push_back(std::move(view));
  }
  add_heading(picture.marks, layout, explorer.loaded()->recording.name, status(explorer), width_px, style);
  if (parts.legend) add_legend(picture.marks, layout, *colouring, style);
  add_footer(picture.marks, layout, width_px, style);
  return picture;
}

}  // namespace sweepscope::ui
