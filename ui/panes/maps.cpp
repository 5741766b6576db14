#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/charts/curve_charts.hpp"
#include "ui/panes/close_ups.hpp"
#include "ui/panes/map_tools.hpp"
#include "ui/panes/number_box.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kMoving_s = 0.2;  // after the last move of a camera, thinned points alone are drawn

/// Draws the map, as far as the frame's time allows.
void render(const PaneContext& context, Side side, const PixelRect& picture) {
  LiveView& view = *context.views[static_cast<std::size_t>(side)];
  const Pane& pane = context.explorer.pane(side);
  const auto points = [](const PlacedCloudPtr& cloud) { return cloud ? cloud->points : nullptr; };
  view.resize(std::max(16, static_cast<int>(picture.width)), std::max(16, static_cast<int>(picture.height)));
  view.set_background(backdrop_of(context));
  const Camera camera = camera_of(view_of(context.settings(), side), context.settings().perspective);
  view.set_camera(camera);
  const ShownCues cues = cues_in(camera, context.settings().cues);
  const double size_px = std::round(context.settings().point_size_px * context.scale);
  view.set_lighting(
      cues.lighting ? std::optional(Lighting{.radius_px = std::round(2 * context.scale), .splat_px = size_px})
                    : std::nullopt);
  view.set_splats(cues.splats);
  view.set_transparent(cues.grid);
  view.set_point_size(size_px);
  view.show(points(pane.coarse), points(pane.full));
  view.set_moving(context.transient.camera_moved_s < kMoving_s || context.transient.handle);
  view.draw(context.draw_budget_s);
}

/// What both panes show: all points as soon as both have them, and the coarse points until then. A map with
/// all its points beside a thinned one would look like a difference.
LiveView::Points shown_points(const PaneContext& context) {
  const std::vector<Side> sides = sides_of(context.settings().layout);
  const bool all = std::all_of(sides.begin(), sides.end(), [&](Side side) {
    return context.views[static_cast<std::size_t>(side)]->has_all_points();
  });
  return all ? LiveView::Points::kAll : LiveView::Points::kCoarse;
}

/// The part of the rendered map between two shares of its width.
void show_texture(const PaneContext& context, Side side, const PixelRect& picture, double from = 0,
                  double to = 1) {
  const unsigned texture = context.views[static_cast<std::size_t>(side)]->texture(shown_points(context));
  if (texture == 0) return;
  const auto x = [&](double share) { return static_cast<float>(picture.left + share * picture.width); };
  // ImGui keeps OpenGL's numbers as pointers.
  const auto id =
      reinterpret_cast<ImTextureID>(std::uintptr_t{texture});  // NOLINT(performance-no-int-to-ptr)
  ImGui::GetWindowDrawList()->AddImage(id, {x(from), static_cast<float>(picture.top)},
                                       {x(to), static_cast<float>(picture.bottom())},
                                       {static_cast<float>(from), 1}, {static_cast<float>(to), 0});
}

/// How far the map is; the picture's own progress is not part of it.
std::string state_of_map(const PaneContext& context, Side side) {
  const Pane& pane = context.explorer.pane(side);
  for (const JobStatus& job : context.explorer.background.status()) {
    const auto& request = pane.request;
    if (!request || pane.state == PaneState::kSolved) break;
    const auto ns = std::llround(request->placement.offset_s * 1e9);
    if (job.key == "solve " + std::to_string(ns))
      return job.running ? fmt::format("solving, {:.0f} %", std::floor(100 * job.fraction)) : "queued";
  }
  if (!pane.problem.empty() && pane.state != PaneState::kSolved) return "not solved";
  if (pane.full && pane.full->beams.empty()) return "no points";
  switch (pane.state) {
    case PaneState::kEmpty:
      return "";
    case PaneState::kProvisional:
      return "beginning only";
    case PaneState::kPreview:
      return "preview";
    case PaneState::kSolved:
      if (!context.explorer.loaded()->poses.empty()) return "along given poses";
      if (pane.lost) return "lost track";
      return pane.warning.empty() ? "solved" : "solved, see Notes";
  }
  return "";
}

/// "solved" only where the picture shows it: until all points are there, it says that they are coming.
std::string state_in_words(const PaneContext& context, Side side) {
  const std::string state = state_of_map(context, side);
  if (state.empty() || shown_points(context) == LiveView::Points::kAll) return state;
  return context.explorer.pane(side).state == PaneState::kSolved ? "refining" : state + ", refining";
}

/// Two links of a chain, apart while the cameras are not linked.
void draw_link(const PaneContext& context, Side side, double left, float middle) {
  const bool linked = context.settings().linked;
  const float size = ImGui::GetFrameHeight(), r = context.pxf(3.2f),
              apart = context.pxf(linked ? 3.0f : 5.0f);
  ImGui::SetCursorScreenPos({static_cast<float>(left), middle - size / 2});
  const char* name = side == Side::kA ? "link a" : "link b";
  if (ImGui::InvisibleButton(name, {size, size})) context.perform(linked ? "linked off" : "linked on");
  context.anchor_last(name);
  const bool hovered = ImGui::IsItemHovered();
  const ImU32 colour = to_imgui(linked || hovered ? context.style.text : context.style.faint_text);
  const float x = static_cast<float>(left) + size / 2;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (hovered)
    list.AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                       ImGui::GetColorU32(ImGuiCol_ButtonHovered), context.pxf(3));
  for (const float way : {-1.0f, 1.0f}) {
    const ImVec2 from{x + way * apart - 1.6f * r, middle - r}, to{x + way * apart + 1.6f * r, middle + r};
    list.AddRect(from, to, colour, r, 0, context.pxf(1.4f));
  }
  tooltip(context, std::string(linked ? "The cameras are linked. " : "The cameras are not linked. ") +
                       find_command("linked")->help + "  [" + chord_of("linked") + "]");
}

/// The map's letter, its offset to drag or type, and how far it is.
void draw_header(const PaneContext& context, Side side, const PixelRect& place) {
  if (place.width <= 0) return;
  const bool a = side == Side::kA;
  const Colour colour = colour_of(context, side);
  const char* command = a ? "offset-a" : "offset-b";
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto middle = static_cast<float>(place.top + place.height / 2);
  const auto left = static_cast<float>(place.left);
  const float half = context.pxf(5.5);
  list.AddRectFilled({left, middle - half}, {left + 2 * half, middle + half}, to_imgui(colour),
                     context.pxf(2));
  ImGui::SetCursorScreenPos({left + context.pxf(19), middle - ImGui::GetFrameHeight() / 2});
  ImGui::PushFont(context.fonts.heading);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(a ? "A" : "B");
  ImGui::PopFont();
  ImGui::SameLine(0, context.pxf(10));
  ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, middle - ImGui::GetFrameHeight() / 2});
  const double shown_ms = offset_ms(context.settings(), side);
  if (context.transient.for_picture) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(fmt::format("offset {} ms", offset_label_ms(shown_ms * 1e-3)).c_str());
    return;
  }
  ImGui::SetNextItemWidth(context.pxf(place.width < context.px(300) ? 84 : 104));
  const std::string label = offset_label_ms(shown_ms * 1e-3);
  NumberBox box = box_of(*find_command(command), 0);
  std::tie(box.least, box.greatest) = context.explorer.offset_window_ms();
  box.step = 1e-3;
  box.format = fmt::format("%.{}f ms", label.size() - label.find('.') - 1);
  number_box(context, box);
  context.anchor_last(command);
  tooltip(context, find_command(command)->help + "  Drag, or click to type.");
  if (context.settings().layout == Layout::kSideBySide || context.settings().layout == Layout::kStacked)
    draw_link(context, side, static_cast<double>(ImGui::GetItemRectMax().x) + context.px(8), middle);
  // Behind what stands before it, or cut: the last line says it whole.
  const double room = place.right() - static_cast<double>(ImGui::GetItemRectMax().x) - context.px(12);
  const std::string state = fit_text(state_in_words(context, side), context.px(11), std::max(room, 0.0));
  ImGui::PushFont(context.fonts.small);
  const ImVec2 size = ImGui::CalcTextSize(state.c_str());
  list.AddText({static_cast<float>(place.right()) - size.x, middle - size.y / 2},
               to_imgui(context.style.faint_text), state.c_str());
  ImGui::PopFont();
}

void draw_frame(const PaneContext& context, const PixelRect& picture) {
  ImGui::GetWindowDrawList()->AddRect(corner(picture), far_corner(picture), to_imgui(context.style.frame));
}

/// A widget that takes the mouse over all of a picture.
void cover(const PaneContext& context, const char* name, const PixelRect& picture) {
  invisible_button(name, picture, kAnyButton);
  ImGui::SetItemAllowOverlap();
  context.anchor(name, picture);
}

/// Before anything is drawn, since linked cameras move both maps in the same frame.
void take_mouse(const PaneContext& context, Side side, const PixelRect& picture) {
  cover(context, side == Side::kA ? "map a" : "map b", picture);
  use_mouse(context, side, picture);
}

/// In a map without points: why it has none, and what may help.
void draw_empty(const PaneContext& context, Side side, const PixelRect& picture) {
  const EmptyPane empty = empty_pane(context.explorer, context.explorer.pane(side));
  if (empty.why.empty()) return;
  const std::string words = sentence(empty.why);
  const double margin = context.px(24), width = std::min(picture.width - 2 * margin, context.px(340));
  const double text_px =
      static_cast<double>(ImGui::CalcTextSize(words.c_str(), nullptr, false, static_cast<float>(width)).y);
  const auto left = static_cast<float>(picture.left + (picture.width - width) / 2);
  ImGui::SetCursorScreenPos({left, static_cast<float>(picture.top + 0.4 * picture.height - text_px / 2)});
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + static_cast<float>(width));
  ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(ink_of(context)));
  ImGui::TextUnformatted(words.c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  context.anchor_last(side == Side::kA ? "empty a" : "empty b");
  for (const Hint& hint : empty.hints) {
    ImGui::SetCursorScreenPos({left, ImGui::GetCursorScreenPos().y});
    ImGui::PushID(side == Side::kA ? "A" : "B");
    button(context, hint.title.c_str(), hint.line, width);
    ImGui::PopID();
  }
}

void draw_map(const PaneContext& context, Side side, const PixelRect& picture) {
  draw_ground(context, side, picture);
  show_texture(context, side, picture);
  draw_overlays(context, side, picture);
  draw_close_up(context, side, picture);
  draw_empty(context, side, picture);
  draw_frame(context, picture);
}

void divider(const PaneContext& context, const PixelRect& picture) {
  const double x = picture.left + context.settings().divider * picture.width, reach = context.px(8);
  invisible_button("divider", {x - reach, picture.top, 2 * reach, picture.height});
  context.anchor_last("divider");
  if (ImGui::IsItemActivated()) context.begin_gesture();
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActive()) {
    const double share =
        (static_cast<double>(ImGui::GetIO().MousePos.x) - picture.left) / std::max(picture.width, 1.0);
    context.perform(Call{find_command("divider"), {std::clamp(std::round(share * 1e3) / 1e3, 0.0, 1.0)}},
                    context.transient.gesture);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = to_imgui(ink_of(context));
  const auto fx = static_cast<float>(x), middle = static_cast<float>(picture.top + picture.height / 2);
  list.AddLine({fx, static_cast<float>(picture.top)}, {fx, static_cast<float>(picture.bottom())}, ink,
               context.pxf(1.5));
  const float r = context.pxf(4), gap = context.pxf(2.5);
  if (!context.transient.for_picture) list.AddCircleFilled({fx, middle}, context.pxf(11), ink);
  for (const float way : {-1.0f, 1.0f})
    if (!context.transient.for_picture)
      list.AddTriangleFilled({fx + way * gap, middle - r}, {fx + way * gap, middle + r},
                             {fx + way * (gap + r), middle}, to_imgui(backdrop_of(context)));
  for (const auto& [letter, way, colour] : {std::tuple{"A", -1.0f, colour_of_a(context.style)},
                                            std::tuple{"B", 1.0f, colour_of_b(context.style)}}) {
    const ImVec2 size = ImGui::CalcTextSize(letter);
    const ImVec2 at{fx + way * context.pxf(18) - size.x / 2,
                    static_cast<float>(picture.top) + context.pxf(10)};
    list.AddRectFilled({at.x - context.pxf(6), at.y - context.pxf(3)},
                       {at.x + size.x + context.pxf(6), at.y + size.y + context.pxf(3)},
                       to_imgui(backdrop_of(context), 0.75), context.pxf(3));
    list.AddText(at, to_imgui(colour), letter);
  }
}

void draw_swipe(const PaneContext& context, const PixelRect& picture) {
  const double share = context.settings().divider;
  draw_ground(context, Side::kB, picture);
  show_texture(context, Side::kA, picture, 0, share);
  show_texture(context, Side::kB, picture, share, 1);
  draw_overlays(context, Side::kB, picture);
  divider(context, picture);
  for (const Side side : kBothSides) draw_close_up(context, side, picture);
  draw_frame(context, picture);
}

}  // namespace

Colour backdrop_of(const PaneContext& context) {
  switch (context.settings().backdrop) {
    case Backdrop::kBlack:
      return {0, 0, 0};
    case Backdrop::kWhite:
      return {255, 255, 255};
    case Backdrop::kTheme:
      break;
  }
  return context.settings().theme == Theme::kLight ? context.style.panel : context.style.map_panel;
}

Colour ink_of(const PaneContext& context) {
  const bool dark = backdrop_of(context).green < 128;
  return dark ? Colour{255, 255, 255} : Colour{20, 23, 28};
}

void draw_maps(const PaneContext& context, const PixelRect& place) {
  begin_panel(context, "maps", place, false);
  const Layout layout = context.settings().layout;
  const MapPlaces places = lay_out_maps(place, context.scale, shown_layout(layout, place, context.scale),
                                        context.settings().map_share);
  const auto picture_of = [&](Side side) { return side == Side::kA ? places.picture_a : places.picture_b; };
  if (layout == Layout::kSwipe) {
    take_mouse(context, Side::kA, places.picture_b);
    for (const Side side : kBothSides) render(context, side, places.picture_b);
    const double half = places.header_b.width / 2 - context.px(8);
    draw_header(context, Side::kA, {places.header_b.left, places.header_b.top, half, places.header_b.height});
    draw_header(context, Side::kB,
                {places.header_b.right() - half, places.header_b.top, half, places.header_b.height});
    draw_swipe(context, places.picture_b);
  } else {
    for (const Side side : sides_of(layout)) take_mouse(context, side, picture_of(side));
    for (const Side side : sides_of(layout)) render(context, side, picture_of(side));
    draw_header(context, Side::kA, places.header_a);
    draw_header(context, Side::kB, places.header_b);
    for (const Side side : sides_of(layout)) draw_map(context, side, picture_of(side));
  }
  end_panel();
}

}  // namespace sweepscope::ui
