#include <fmt/format.h>

#include <cmath>

#include "render/charts/curve_charts.hpp"
#include "ui/panes/map_tools.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kMoving_s = 0.2;        // after the last move of a camera, thinned points alone are drawn
constexpr double kDrawBudget_s = 0.012;  // of each pane and frame; a slice may go beyond it

ImVec2 corner(const PixelRect& rect) {
  return {static_cast<float>(rect.left), static_cast<float>(rect.top)};
}
ImVec2 far_corner(const PixelRect& rect) {
  return {static_cast<float>(rect.right()), static_cast<float>(rect.bottom())};
}

Colour backdrop(const PaneContext& context) {
  switch (context.settings().backdrop) {
    case Backdrop::kBlack:
      return {0, 0, 0};
    case Backdrop::kWhite:
      return {255, 255, 255};
    case Backdrop::kTheme:
      break;
  }
  return context.style.map_panel;
}

/// Draws the map into its texture, as far as the frame's time allows.
void render(const PaneContext& context, Side side, const PixelRect& picture) {
  LiveView& view = *context.views[static_cast<std::size_t>(side)];
  const Pane& pane = context.explorer.pane(side);
  const auto points = [](const PlacedCloudPtr& cloud) { return cloud ? cloud->points : nullptr; };
  view.resize(std::max(16, static_cast<int>(picture.width)), std::max(16, static_cast<int>(picture.height)));
  view.set_background(backdrop(context));
  view.set_point_size(std::round(context.settings().point_size_px * context.scale));
  view.set_camera(camera_of(view_of(context.settings(), side), context.settings().perspective));
  view.show(points(pane.coarse), points(pane.full));
  view.set_moving(context.transient.camera_moved_s < kMoving_s || context.transient.handle);
  view.draw(kDrawBudget_s);
}

/// The part of the rendered map between two shares of its width.
void show_texture(const PaneContext& context, Side side, const PixelRect& picture, double from = 0,
                  double to = 1) {
  const unsigned texture = context.views[static_cast<std::size_t>(side)]->texture();
  if (texture == 0) return;
  const auto x = [&](double share) { return static_cast<float>(picture.left + share * picture.width); };
  // ImGui keeps OpenGL's numbers as pointers.
  const auto id =
      reinterpret_cast<ImTextureID>(std::uintptr_t{texture});  // NOLINT(performance-no-int-to-ptr)
  ImGui::GetWindowDrawList()->AddImage(id, {x(from), static_cast<float>(picture.top)},
                                       {x(to), static_cast<float>(picture.bottom())},
                                       {static_cast<float>(from), 1}, {static_cast<float>(to), 0});
}

std::string state_in_words(const PaneContext& context, Side side) {
  const Pane& pane = context.explorer.pane(side);
  for (const JobStatus& job : context.explorer.background().status()) {
    const auto& request = pane.request;
    if (!request || pane.state == PaneState::kSolved) break;
    const auto ns = std::llround(request->placement.offset_s * 1e9);
    if (job.key == "solve " + std::to_string(ns))
      return job.running ? fmt::format("solving, {:.0f} %", std::floor(100 * job.fraction)) : "queued";
  }
  if (!pane.problem.empty() && pane.state != PaneState::kSolved) return "not solved";
  switch (pane.state) {
    case PaneState::kEmpty:
      return "";
    case PaneState::kProvisional:
      return "first second only";
    case PaneState::kPreview:
      return "preview";
    case PaneState::kSolved:
      if (!context.explorer.loaded()->poses.empty()) return "along given poses";
      return pane.lost ? "lost track" : "solved";
  }
  return "";
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
  const Colour colour = a ? colour_of_a(context.style) : colour_of_b(context.style);
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
  double offset_ms = a ? context.settings().offset_a_ms : context.settings().offset_b_ms;
  ImGui::SetNextItemWidth(context.pxf(104));
  const int decimals = std::abs(offset_ms * 10 - std::round(offset_ms * 10)) < 1e-6 ? 1 : 3;
  const std::string format = fmt::format("%.{}f ms", decimals);
  const bool edited = ImGui::DragScalar((std::string("##") + command).c_str(), ImGuiDataType_Double,
                                        &offset_ms, 0.02f, nullptr, nullptr, format.c_str());
  context.anchor_last(command);
  if (ImGui::IsItemActivated()) context.begin_gesture();
  if (edited)
    context.perform(Call{find_command(command), {std::clamp(std::round(offset_ms * 1e3) / 1e3, -1e4, 1e4)}},
                    context.transient.gesture);
  tooltip(context, find_command(command)->help + "  Drag, or double-click to type.");
  if (context.settings().layout == Layout::kSideBySide)
    draw_link(context, side, static_cast<double>(ImGui::GetItemRectMax().x) + context.px(8), middle);
  const std::string state = state_in_words(context, side);
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
  ImGui::SetCursorScreenPos(corner(picture));
  ImGui::InvisibleButton(name, {static_cast<float>(picture.width), static_cast<float>(picture.height)},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  ImGui::SetItemAllowOverlap();
  context.anchor(name, picture);
}

void draw_map(const PaneContext& context, Side side, const PixelRect& picture) {
  cover(context, side == Side::kA ? "map a" : "map b", picture);
  use_mouse(context, side, picture);
  render(context, side, picture);
  show_texture(context, side, picture);
  draw_overlays(context, side, picture);
  draw_frame(context, picture);
}

void divider(const PaneContext& context, const PixelRect& picture) {
  const double x = picture.left + context.settings().divider * picture.width, reach = context.px(8);
  ImGui::SetCursorScreenPos({static_cast<float>(x - reach), static_cast<float>(picture.top)});
  ImGui::InvisibleButton("divider", {static_cast<float>(2 * reach), static_cast<float>(picture.height)});
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
  const auto fx = static_cast<float>(x), middle = static_cast<float>(picture.top + picture.height / 2);
  list.AddLine({fx, static_cast<float>(picture.top)}, {fx, static_cast<float>(picture.bottom())},
               IM_COL32_WHITE, context.pxf(1.5));
  list.AddCircleFilled({fx, middle}, context.pxf(11), IM_COL32_WHITE);
  const float r = context.pxf(4), gap = context.pxf(2.5);
  for (const float way : {-1.0f, 1.0f})
    list.AddTriangleFilled({fx + way * gap, middle - r}, {fx + way * gap, middle + r},
                           {fx + way * (gap + r), middle}, IM_COL32(20, 23, 28, 255));
  for (const auto& [letter, way, colour] : {std::tuple{"A", -1.0f, colour_of_a(context.style)},
                                            std::tuple{"B", 1.0f, colour_of_b(context.style)}}) {
    const ImVec2 size = ImGui::CalcTextSize(letter);
    const ImVec2 at{fx + way * context.pxf(18) - size.x / 2,
                    static_cast<float>(picture.top) + context.pxf(10)};
    list.AddRectFilled({at.x - context.pxf(6), at.y - context.pxf(3)},
                       {at.x + size.x + context.pxf(6), at.y + size.y + context.pxf(3)},
                       IM_COL32(10, 12, 15, 190), context.pxf(3));
    list.AddText(at, to_imgui(colour), letter);
  }
}

void draw_swipe(const PaneContext& context, const PixelRect& picture) {
  cover(context, "map a", picture);
  use_mouse(context, Side::kA, picture);
  const double share = context.settings().divider;
  for (const Side side : kBothSides) render(context, side, picture);
  show_texture(context, Side::kA, picture, 0, share);
  show_texture(context, Side::kB, picture, share, 1);
  draw_overlays(context, Side::kB, picture);
  divider(context, picture);
  draw_frame(context, picture);
}

}  // namespace

void draw_maps(const PaneContext& context, const PixelRect& place) {
  begin_panel(context, "maps", place, false);
  const Layout layout = context.settings().layout;
  const MapPlaces places = lay_out_maps(place, context.scale, layout);
  if (layout == Layout::kSwipe) {
    const double half = places.header_b.width / 2 - context.px(8);
    draw_header(context, Side::kA, {places.header_b.left, places.header_b.top, half, places.header_b.height});
    draw_header(context, Side::kB,
                {places.header_b.right() - half, places.header_b.top, half, places.header_b.height});
    draw_swipe(context, places.picture_b);
  } else {
    draw_header(context, Side::kA, places.header_a);
    draw_header(context, Side::kB, places.header_b);
    if (places.picture_a.width > 0) draw_map(context, Side::kA, places.picture_a);
    if (places.picture_b.width > 0) draw_map(context, Side::kB, places.picture_b);
  }
  end_panel();
}

}  // namespace sweepscope::ui
