#include "ui/panes/map_tools.hpp"

#include <fmt/format.h>

#include <cmath>

#include "render/charts/ticks.hpp"
#include "render/comparison/comparison_marks.hpp"
#include "render/comparison/scanner_pose.hpp"
#include "ui/host/paint.hpp"
#include "ui/model/picking.hpp"
#include "ui/model/playback.hpp"
#include "ui/panes/close_ups.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

void set_view(const PaneContext& context, Side side, const ViewPoint& view) {
  const bool b = side == Side::kB && !context.settings().linked;
  const auto millimetres = [](double metres) { return std::round(metres * 1e4) / 1e4; };
  const Call call{find_command(b ? "camera-b" : "camera-a"),
                  {millimetres(view.centre_m.x()), millimetres(view.centre_m.y()),
                   millimetres(view.centre_m.z()), millimetres(view.height_m),
                   std::round(view.turn_deg * 100) / 100, std::round(view.elevation_deg * 100) / 100}};
  context.perform(call, context.transient.gesture);
  context.transient.camera_moved_s = 0;
}

bool any_activated() {
  return ImGui::IsItemClicked(0) || ImGui::IsItemClicked(1) || ImGui::IsItemClicked(2);
}

void drag_camera(const PaneContext& context, Side side, const PixelRect& picture) {
  if (any_activated()) context.begin_gesture();
  const int button = held_button();
  if (!ImGui::IsItemActive() || !is_dragged(context, button)) return;
  // Since the press at first, and since the last frame from then on: nothing of a drag is lost.
  const ImVec2 delta = ImGui::GetMouseDragDelta(button, 0);
  ImGui::ResetMouseDragDelta(button);
  if (delta.x == 0 && delta.y == 0) return;
  const double right = static_cast<double>(delta.x), down = static_cast<double>(delta.y);
  const ViewPoint& view = view_of(context.settings(), side);
  const bool left = ImGui::IsMouseDown(0);
  if (left && context.settings().tool != Tool::kLook) return;
  if (left && !ImGui::GetIO().KeyShift)
    set_view(context, side, turned(view, right / context.scale, down / context.scale));
  else
    set_view(context, side, moved(view, right, down, picture.height));
}

void zoom(const PaneContext& context, Side side, const PixelRect& picture) {
  const double wheel = static_cast<double>(ImGui::GetIO().MouseWheel);
  if (!ImGui::IsItemHovered() || wheel == 0) return;
  if (context.transient.camera_moved_s > 0.5) context.begin_gesture();
  set_view(context, side, zoomed(view_of(context.settings(), side), std::pow(1.15, wheel), mouse(), picture));
}

const PlacedCloud* shown_cloud(const PaneContext& context, Side side) {
  const Pane& pane = context.explorer.pane(side);
  return pane.full ? pane.full.get() : pane.coarse.get();
}

/// The first click is one end of what is measured, the second the other.
void measure_to(const PaneContext& context, const Eigen::Vector3d& place_m) {
  std::optional<Eigen::Vector3d>& from_m = context.transient.measure_from_m;
  if (!from_m) {
    from_m = place_m;
    return;
  }
  const Eigen::Vector3d a = *from_m;
  from_m.reset();
  context.perform(fmt::format("measure {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f}", a.x(), a.y(), a.z(),
                              place_m.x(), place_m.y(), place_m.z()));
}

void pick(const PaneContext& context, Side side, const PixelRect& picture) {
  const PlacedCloud* cloud = shown_cloud(context, side);
  if (cloud == nullptr || !ImGui::IsItemClicked(0)) return;
  const auto found =
      pick_point(*cloud, projection_of(context.settings(), side, picture), mouse(), context.px(12));
  const bool picks = context.settings().tool == Tool::kPick;
  if (picks && found) {
    const Beams& beams = context.explorer.loaded()->beams;
    const std::uint32_t beam = cloud->beams[*found];
    return context.perform(fmt::format("pick {} {}", beams.scan[beam], beams.beam[beam]));
  }
  if (picks) return context.perform("pick -1 -1");
  if (!found) return;
  const auto& p = cloud->points->xyz_m[*found];
  measure_to(context, {p[0], p[1], p[2]});
}

/// A double click looks at the point there: the view turns about it from now on.
void centre_on_point(const PaneContext& context, Side side, const PixelRect& picture) {
  if (!ImGui::IsItemHovered() || !ImGui::IsMouseDoubleClicked(0)) return;
  ViewPoint view = view_of(context.settings(), side);
  const PlacedCloud* cloud = shown_cloud(context, side);
  const auto found = cloud != nullptr ? pick_point(*cloud, projection_of(context.settings(), side, picture),
                                                   mouse(), context.px(12))
                                      : std::nullopt;
  if (found) {
    const auto& p = cloud->points->xyz_m[*found];
    view.centre_m = {p[0], p[1], p[2]};
  } else {
    view.centre_m = place_under(mouse(), view, picture);
  }
  context.begin_gesture();
  set_view(context, side, view);
}

void draw_profile_line(const PaneContext& context, Side side, const PixelRect& picture) {
  Transient& transient = context.transient;
  const Eigen::Vector2d here = place_under(mouse(), view_of(context.settings(), side), picture).head<2>();
  if (ImGui::IsItemClicked(0)) {
    transient.profile_from_m = here;
    context.begin_gesture();
  }
  if (!ImGui::IsMouseDown(0)) transient.profile_from_m.reset();
  // The other map's pane asks too, and is not the one that is dragged over.
  if (!transient.profile_from_m || !ImGui::IsItemActive()) return;
  const auto round = [](double metres) { return std::round(metres * 1e3) / 1e3; };
  const Eigen::Vector2d& from = *transient.profile_from_m;
  context.perform(
      Call{find_command("profile"), {round(from.x()), round(from.y()), round(here.x()), round(here.y())}},
      transient.gesture);
}

/// A line with dark edges, legible on any colour.
void outlined(ImDrawList& list, const std::vector<ImVec2>& points, ImU32 colour, float width) {
  const auto count = static_cast<int>(points.size());
  list.AddPolyline(points.data(), count, IM_COL32(0, 0, 0, 150), 0, width + 2);
  list.AddPolyline(points.data(), count, colour, 0, width);
}

std::optional<ImVec2> to_screen(const Projection& projection, const Eigen::Vector3d& p_m) {
  const auto at = projection(p_m);
  if (!at) return std::nullopt;
  return vec(at->x, at->y);
}

void draw_path(const PaneContext& context, Side side, const Projection& projection) {
  const auto& request = context.explorer.pane(side).request;
  if (!context.settings().trajectory || !request) return;
  // A walk has a hundred poses a second: drawn one by one, shorter than a pixel, they take longer than the
  // map.
  constexpr float kMinStep_px = 1;
  std::vector<ImVec2> points;
  for (const StampedPose& pose : request->placement.map->trajectory) {
    const auto at = to_screen(projection, pose.position_m);
    if (!at) continue;
    if (points.empty() || std::hypot(at->x - points.back().x, at->y - points.back().y) >= kMinStep_px)
      points.push_back(*at);
  }
  if (points.size() < 2) return;
  ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()),
                                          to_imgui(ink_of(context), 0.75), 0, context.pxf(1.2));
}

/// Bottom left, above a close-up that reaches there: a round length. Only where all of the picture has one
/// scale.
void draw_scale_bar(const PaneContext& context, const PixelRect& picture, const Projection& projection) {
  if (context.settings().perspective) return;
  const double metres = round_length(0.22 * picture.width * projection.metres_per_px());
  const double length_px = metres / projection.metres_per_px();
  const std::string label =
      metres < 0.995 ? fmt::format("{:g} cm", metres * 100) : fmt::format("{:g} m", metres);
  const double text_px = text_width_px(label, context.px(11));
  const double x = picture.left + context.px(16), end = x + length_px + text_px + context.px(18);
  const auto close_ups = close_ups_in(context, picture);
  const bool above = !close_ups.empty() && close_ups.front().left < end;
  const double y = (above ? close_ups.front().top : picture.bottom()) - context.px(18);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(vec(x - context.px(8), y - context.px(11)), vec(end, y + context.px(11)),
                     to_imgui(backdrop_of(context), 0.7), context.pxf(3));
  Drawing bar;
  const Colour ink = ink_of(context);
  bar.line({x, y}, {x + length_px, y}, context.px(1.5), ink);
  for (const double at : {x, x + length_px})
    bar.line({at, y - context.px(4)}, {at, y + context.px(4)}, context.px(1.5), ink);
  bar.add(TextMark{
      {x + length_px + context.px(8), y}, label, context.px(11), ink, AlignX::kLeft, AlignY::kMiddle});
  paint(list, bar, context.fonts);
}

void draw_measure(const PaneContext& context, const Projection& projection) {
  const Settings& s = context.settings();
  std::vector<Eigen::Vector3d> ends;
  if (context.transient.measure_from_m)
    ends = {*context.transient.measure_from_m};
  else if (s.measure_from_m != s.measure_to_m)
    ends = {s.measure_from_m, s.measure_to_m};
  std::vector<ImVec2> points;
  for (const Eigen::Vector3d& end : ends) {
    if (const auto at = to_screen(projection, end)) points.push_back(*at);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (points.size() == 2) outlined(list, points, IM_COL32_WHITE, context.pxf(1.5));
  for (const ImVec2& point : points) {
    list.AddCircleFilled(point, context.pxf(5), IM_COL32(0, 0, 0, 160));
    list.AddCircle(point, context.pxf(4.5), IM_COL32_WHITE, 0, context.pxf(1.5));
  }
}

void draw_picked(const PaneContext& context, Side side, const Projection& projection) {
  const auto& request = context.explorer.pane(side).request;
  if (!request) return;
  const auto beam = beam_asked(context.settings(), context.explorer.loaded()->beams);
  if (!beam) return;
  const Placement& placement = request->placement;
  const auto place =
      place_beams(placement.loaded->beams, placement.map->path, placement.offset_s, std::array{*beam});
  if (!std::isfinite(place[0][0])) return;
  const auto at = to_screen(projection, {place[0][0], place[0][1], place[0][2]});
  if (!at) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircle(*at, context.pxf(8), IM_COL32(0, 0, 0, 180), 0, context.pxf(4));
  list.AddCircle(*at, context.pxf(8), IM_COL32_WHITE, 0, context.pxf(2));
}

/// Where the scanner is at the moment that is played, or at the end of the time that is shown.
void draw_scanner(const PaneContext& context, Side side, const Projection& projection) {
  const Settings& s = context.settings();
  const auto& request = context.explorer.pane(side).request;
  if (!cues_in(camera_of(view_of(s, side), s.perspective), s.cues).scanner || !request) return;
  const Recording& recording = request->placement.loaded->recording;
  const double until_s = scanner_time_s(recording, s);
  const ScannerMark mark{
      scanner_pose(recording, request->placement.map->trajectory, request->placement.offset_s, until_s),
      context.px(26), ink_of(context)};
  paint(*ImGui::GetWindowDrawList(), scanner_marks(mark, projection), context.fonts);
}

/// The directions of the axes, at the upper right, unless the map is seen from above with x to the right.
void draw_axes(const PaneContext& context, Side side, const PixelRect& picture) {
  const Camera camera = camera_of(view_of(context.settings(), side), context.settings().perspective);
  if (is_plan(camera) && camera.up.y() > 1 - 1e-9) return;
  const double side_px = axes_side_px(context.scale);
  if (picture.width < 3 * side_px || picture.height < 3 * side_px) return;
  Drawing drawing;
  add_axes(drawing,
           {picture.right() - side_px - context.px(8), picture.top + context.px(8), side_px, side_px}, camera,
           ink_of(context), context.scale);
  paint(*ImGui::GetWindowDrawList(), drawing, context.fonts);
}

void draw_profile(const PaneContext& context, const Projection& projection, double z_m) {
  const Settings& s = context.settings();
  if (s.profile_from_m == s.profile_to_m) return;
  const auto from = to_screen(projection, {s.profile_from_m.x(), s.profile_from_m.y(), z_m});
  const auto to = to_screen(projection, {s.profile_to_m.x(), s.profile_to_m.y(), z_m});
  if (!from || !to) return;
  outlined(*ImGui::GetWindowDrawList(), {*from, *to}, IM_COL32_WHITE, context.pxf(1.5));
  for (const ImVec2& end : {*from, *to})
    ImGui::GetWindowDrawList()->AddCircleFilled(end, context.pxf(3.5), IM_COL32_WHITE);
}

}  // namespace

const ViewPoint& view_of(const Settings& settings, Side side) {
  return side == Side::kA ? settings.camera_a : settings.camera_b;
}

Projection projection_of(const Settings& settings, Side side, const PixelRect& picture) {
  return ui::projection_of(view_of(settings, side), settings.perspective, picture);
}

void use_mouse(const PaneContext& context, Side side, const PixelRect& picture) {
  drag_camera(context, side, picture);
  zoom(context, side, picture);
  const Tool tool = context.settings().tool;
  if (tool == Tool::kLook) centre_on_point(context, side, picture);
  if (tool == Tool::kPick || tool == Tool::kMeasure) pick(context, side, picture);
  if (tool == Tool::kProfile) draw_profile_line(context, side, picture);
  if (tool != Tool::kLook && ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

void draw_ground(const PaneContext& context, Side side, const PixelRect& picture) {
  const auto& request = context.explorer.pane(side).request;
  const Camera camera = camera_of(view_of(context.settings(), side), context.settings().perspective);
  if (!cues_in(camera, context.settings().cues).grid || !request) return;
  const Projection projection(camera, picture);
  const SolvedMap& map = *request->placement.map;
  GroundGrid grid = ground_grid(map.main_box, projection, context.px(60));
  grid.line_px = context.px(1);
  grid.text_px = context.px(11);
  grid.lines = grid.text = ink_of(context);
  grid.lines.alpha = 40;
  grid.text.alpha = 150;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from = corner(picture), to = far_corner(picture);
  list.PushClipRect(from, to, true);
  list.AddRectFilled(from, to, to_imgui(backdrop_of(context)));
  paint(list, grid_marks(grid, camera, projection), context.fonts);
  list.PopClipRect();
}

void draw_overlays(const PaneContext& context, Side side, const PixelRect& picture) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(corner(picture), far_corner(picture), true);
  const Projection projection = projection_of(context.settings(), side, picture);
  draw_path(context, side, projection);
  draw_played_scan(context, side, projection);
  draw_place_mark(context, projection);
  draw_profile(context, projection, view_of(context.settings(), side).centre_m.z());
  draw_measure(context, projection);
  draw_picked(context, side, projection);
  draw_scanner(context, side, projection);
  draw_axes(context, side, picture);
  draw_scale_bar(context, picture, projection);
  list.PopClipRect();
}

void draw_cards(const PaneContext& context, const PixelRect& maps) {
  const Settings& settings = context.settings();
  const Explorer& explorer = context.explorer;
  std::vector<std::pair<std::string, std::string>> rows;
  const auto &a = explorer.pane(Side::kA).request, &b = explorer.pane(Side::kB).request;
  const auto beam = beam_asked(settings, explorer.loaded()->beams);
  if (beam && a && b) rows = describe_beam(a->placement, b->placement, *beam);
  // One card at a time: of the tool at hand, or of whichever left something.
  const bool measured = settings.measure_from_m != settings.measure_to_m;
  if (measured && (rows.empty() || settings.tool == Tool::kMeasure)) {
    const Eigen::Vector3d apart_m = settings.measure_to_m - settings.measure_from_m;
    rows = {{"distance", fmt::format("{:.3f} m", apart_m.norm())},
            {"level", fmt::format("{:.3f} m", apart_m.head<2>().norm())},
            {"height", fmt::format("{:+.3f} m", apart_m.z())}};
  }
  if (rows.empty()) return;
  const double height = context.px(22) + static_cast<double>(rows.size()) * context.px(20);
  const PixelRect place{maps.left + context.px(24), maps.top + context.px(48), context.px(270), height};
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, context.pxf(5));
  ImGui::SetNextWindowBgAlpha(0.92f);
  begin_panel(context, "card", place, true, true);
  for (const auto& [name, value] : rows) row(context, name.c_str(), value);
  end_panel();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

}  // namespace sweepscope::ui
