#include "ui/panes/close_ups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/host/paint.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/panes/layout.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

const char* name_of(std::size_t map) {
  return map == 0 ? "A" : "B";
}

std::string position_in_words(const PlaceToLook& place) {
  const auto metres = [](double value) {
    const double tenths = std::round(value * 10);
    return fmt::format("{}{:.1f} m", tenths < 0 ? "−" : "", std::abs(tenths) / 10);
  };
  const Eigen::Vector2d& centre_m = place.found.region.centre_m;
  return fmt::format("x {}, y {}", metres(centre_m.x()), metres(centre_m.y()));
}

/// Of the maps that are compared: while others are being placed there are no such words.
std::string difference_in_words(const Explorer& explorer, const PlaceToLook& place) {
  if (!explorer.places_hold()) return "these maps are still being compared";
  return fmt::format("{} is {:.1f} times as blurred as {} here", name_of(place.found.most_blurred()),
                     place.found.ratio(), name_of(place.found.sharpest()));
}

std::size_t number_of(const Explorer& explorer) {
  const auto& places = explorer.places.all();
  return 1 +
         static_cast<std::size_t>(std::find(places.begin(), places.end(), explorer.place()) - places.begin());
}

ImTextureID picture_of(const PaneContext& context, Side side, const PixelRect& place,
                       const PlaceToLook& shown) {
  LiveView& view = *context.close_ups[static_cast<std::size_t>(side)];
  const Pane& pane = context.explorer.pane(side);
  view.resize(static_cast<int>(place.width), static_cast<int>(place.height));
  view.set_background(backdrop_of(context));
  view.set_point_size(std::round(context.settings().point_size_px * context.scale));
  view.set_camera(camera_of(shown.view(), false));
  view.show(pane.close_up ? pane.close_up->points : nullptr, nullptr);
  view.draw(0);
  // ImGui keeps OpenGL's numbers as pointers.
  return reinterpret_cast<ImTextureID>(  // NOLINT(performance-no-int-to-ptr)
      std::uintptr_t{view.texture(LiveView::Points::kCoarse)});
}

/// A square button with a sign of two strokes through the given points, which reach from -1 to 1.
void sign_button(const PaneContext& context, const std::string& line, const PixelRect& place,
                 const std::array<ImVec2, 3>& stroke) {
  if (invisible_button(line, place)) context.perform(line);
  context.anchor_last("button " + line);
  const bool hovered = ImGui::IsItemHovered();
  const Command& command = *find_command(line.substr(0, line.find(' ')));
  tooltip(context, fmt::format("{}  [{}]", command.help, chord_of(line)));
  const float x = static_cast<float>(place.left + place.width / 2),
              y = static_cast<float>(place.top + place.height / 2);
  const float r = context.pxf(3.5);
  std::array<ImVec2, 3> points{};
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {x + r * stroke[i].x, y + r * stroke[i].y};
  ImGui::GetWindowDrawList()->AddPolyline(points.data(), 3, to_imgui(ink_of(context), hovered ? 1 : 0.6), 0,
                                          context.pxf(1.5));
}

/// "1 of 8", with what steps and closes.
void draw_bar(const PaneContext& context, Side side, const PixelRect& bar) {
  const PixelRect last{bar.right() - bar.height, bar.top, bar.height, bar.height};
  PixelRect left{bar.left, bar.top, bar.height, bar.height};
  ImGui::PushID(side == Side::kA ? "A" : "B");
  sign_button(context, "next-place back", left, {{{0.5f, -1}, {-0.5f, 0}, {0.5f, 1}}});
  const std::string words =
      fmt::format("{} of {}", number_of(context.explorer), context.explorer.places.all().size());
  ImGui::PushFont(context.fonts.small);
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  const float middle = static_cast<float>(bar.top + bar.height / 2);
  ImGui::GetWindowDrawList()->AddText({static_cast<float>(left.right()), middle - size.y / 2},
                                      to_imgui(ink_of(context), 0.6), words.c_str());
  ImGui::PopFont();
  left.left += left.width + static_cast<double>(size.x);
  sign_button(context, "next-place", left, {{{-0.5f, -1}, {0.5f, 0}, {-0.5f, 1}}});
  sign_button(context, "close-up", last, {{{-0.8f, 0.8f}, {0, 0.8f}, {0.8f, 0.8f}}});
  ImGui::PopID();
}

}  // namespace

std::vector<PixelRect> close_ups_in(const PaneContext& context, const PixelRect& picture) {
  if (!context.explorer.place()) return {};
  return close_up_places(picture, context.scale, context.settings().layout,
                         context.explorer.view.spare_height());
}

void draw_close_up(const PaneContext& context, Side side, const PixelRect& picture) {
  const PlacePtr shown = context.explorer.place();
  const Layout layout = context.settings().layout;
  const std::vector<PixelRect> places = close_ups_in(context, picture);
  if (!shown || places.empty()) return;
  const PixelRect& place = layout == Layout::kSwipe && side == Side::kB ? places.back() : places.front();
  const char* name = side == Side::kA ? "close-up a" : "close-up b";
  invisible_button(name, place);
  ImGui::SetItemAllowOverlap();
  context.anchor(name, place);
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) context.perform("look-at-place");
  tooltip(context,
          fmt::format(
              "{:.1f} m of the map at {}, one of the places where the maps differ most: {}. A blurred "
              "surface fills more cells of 5 cm. N and Shift+N go to the other places, a double "
              "click looks at this one.",
              shown->width_m(), position_in_words(*shown), difference_in_words(context.explorer, *shown)));
  const ImVec2 from = corner(place), to = far_corner(place);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(picture_of(context, side, place, *shown), from, to, {0, 1}, {1, 0});
  const PixelRect bar{place.left, place.top, place.width, context.px(20)};
  if (!context.transient.for_picture) {
    list.AddRectFilled(from, far_corner(bar), to_imgui(backdrop_of(context), 0.85));
    draw_bar(context, side, bar);
  }
  list.AddRect(from, to, to_imgui(colour_of(context, side)), 0, 0, context.pxf(1.5));
}

void draw_place_mark(const PaneContext& context, const Projection& projection) {
  const PlacePtr shown = context.explorer.place();
  if (!shown) return;
  const Eigen::Vector2d& centre_m = shown->found.region.centre_m;
  std::vector<ImVec2> corners;
  for (const auto& [x, y] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
    const auto at = projection(
        {centre_m.x() + x * shown->width_m() / 2, centre_m.y() + y * shown->height_m() / 2, shown->z_m});
    if (!at) return;
    corners.push_back(vec(at->x, at->y));
  }
  ImGui::GetWindowDrawList()->AddPolyline(corners.data(), static_cast<int>(corners.size()),
                                          to_imgui(ink_of(context), 0.75), ImDrawFlags_Closed,
                                          context.pxf(1));
}

void place_field(const PaneContext& context) {
  const auto& places = context.explorer.places.all();
  const Command& command = *find_command("place");
  begin_field(context, command);
  const bool any = context.explorer.place() != nullptr;
  const std::string now = any ? fmt::format("{} of {}", number_of(context.explorer), places.size()) : "None";
  if (ImGui::BeginCombo("##place", now.c_str())) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::string words =
          fmt::format("{0}   {1}:  {2}###place {0}", i + 1, position_in_words(*places[i]),
                      difference_in_words(context.explorer, *places[i]));
      if (ImGui::Selectable(words.c_str(), places[i] == context.explorer.place()))
        context.perform(fmt::format("place {}", i + 1));
      if (places[i] == context.explorer.place()) ImGui::SetItemDefaultFocus();
      context.anchor_last(fmt::format("place {}", i + 1));
    }
    if (places.empty()) ImGui::TextDisabled("The maps are not both solved, or they do not differ.");
    ImGui::EndCombo();
  }
  context.anchor_last("place");
  tooltip(context, command.help);
}

}  // namespace sweepscope::ui
