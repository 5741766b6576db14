#include "ui/explorer/maps_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "render/charts/curve_charts.hpp"
#include "render/comparison/comparison_layout.hpp"
#include "render/comparison/comparison_marks.hpp"
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
  if (s.backdrop == Backdrop::kWhite) return sweepscope::Background::kWhite;
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
  scene.camera = camera_for(side == Side::kA ? s.camera_a : s.camera_b, s.perspective, pane_aspect, place);
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
                    {s.cues,
                     {{map.x_m.from, map.y_m.from, map.z_m.from}, {map.x_m.to, map.y_m.to, map.z_m.to}},
                     scanner_pose(recording, map.trajectory, placement.offset_s, until_s),
                     layout.scale},
                    style);
}

}  // namespace

Result<Picture> maps_picture(const Explorer& explorer, int width_px, int height_px, double pane_aspect) {
  const Settings& s = explorer.settings();
  ComparisonOptions options;
  options.width_px = width_px;
  options.height_px = height_px;
  options.with_close_up = false;
  options.background = background_of(s);
  if (auto usable = check_size(options); !usable) return tl::unexpected(usable.error());
  const bool difference = s.layout == Layout::kDifference;
  const ColourSpan span = explorer.maps.shown_span();
  const std::vector<float> no_values;
  const std::array none{std::span<const float>(no_values)};
  auto colouring = make_colouring(difference ? ColourBy::kDistance : s.colouring, s.table, none,
                                  ValueRange{span.from, span.to});
  if (!colouring) return tl::unexpected(colouring.error());
  const std::vector<Side> sides = sides_of(s.layout);
  const Style style = style_of(options.background);
  const ComparisonLayout layout = lay_out(options, sides.size(), 0);
  Picture picture{width_px, height_px, style.page, {}, {}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Pane& pane = explorer.pane(sides[i]);
    if (!pane.request || (!pane.full && !pane.coarse)) continue;
    const bool a = sides[i] == Side::kA;
    add_label(
        picture.marks, layout.labels[i], layout.overviews[i].width,
        fmt::format("{}  offset {} ms", a ? "A" : "B", offset_label_ms(pane.request->placement.offset_s)),
        style.maps[a ? 0 : 1], style, layout.scale);
    View view = view_of(explorer, sides[i], layout.overviews[i], pane_aspect, layout, style);
    add_overview_marks(picture.marks, Projection(view.scene.camera, view.place), view.scene.camera, style,
                       layout.scale);
    picture.views.push_back(std::move(view));
  }
  add_heading(picture.marks, layout, explorer.loaded()->recording.name, status(explorer), width_px, style);
  add_legend(picture.marks, layout, *colouring, style);
  add_footer(picture.marks, layout, width_px, style);
  return picture;
}

}  // namespace sweepscope::ui
