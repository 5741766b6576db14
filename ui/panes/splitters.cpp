#include <algorithm>
#include <cmath>

#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kReach = 4;  // of the mouse, to either side of an edge, at 100 %

struct Splitter {
  const char* name;     // of its anchor
  const char* command;  // what a drag sets
  bool upright;         // it is dragged to the left and right
  PixelRect edge;       // what the mouse takes
};

/// What a drag to this place sets.
double value_at(const PaneContext& context, const Splitter& splitter, const Places& places,
                const PixelRect& whole, PixelPoint mouse) {
  const std::string command = splitter.command;
  if (command == "left-width") return mouse.x / context.scale;
  if (command == "right-width") return (whole.width - mouse.x) / context.scale;
  if (command == "charts-height") return (places.criteria.bottom() - mouse.y) / context.scale;
  return splitter.upright ? (mouse.x - places.maps.left) / std::max(places.maps.width, 1.0)
                          : (mouse.y - places.maps.top) / std::max(places.maps.height, 1.0);
}

void use(const PaneContext& context, const Splitter& splitter, const Places& places, const PixelRect& whole) {
  ImGui::SetNextWindowBgAlpha(0);
  begin_panel(context, splitter.name, splitter.edge, false, true);
  ImGui::InvisibleButton("edge", extent(splitter.edge));
  context.anchor(splitter.name, splitter.edge);
  const bool held = ImGui::IsItemActive();
  if (ImGui::IsItemActivated()) context.begin_gesture();
  const bool reset = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
  const Command& command = *find_command(splitter.command);
  if (held || ImGui::IsItemHovered()) {
    ImGui::SetMouseCursor(splitter.upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    const PixelRect& e = splitter.edge;
    const auto x = static_cast<float>(e.left + e.width / 2), y = static_cast<float>(e.top + e.height / 2);
    const ImU32 colour = to_imgui(colour_of_b(context.style), held ? 1 : 0.6);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (splitter.upright)
      list.AddLine({x, static_cast<float>(e.top)}, {x, static_cast<float>(e.bottom())}, colour,
                   context.pxf(2));
    else
      list.AddLine({static_cast<float>(e.left), y}, {static_cast<float>(e.right()), y}, colour,
                   context.pxf(2));
  }
  end_panel();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool is_share = std::string(splitter.command) == "map-share";
  if (reset) return context.perform(Call{&command, {is_share ? 0.5 : 0.0}});
  if (!held || !is_dragged(context, 0)) return;
  const double wanted = value_at(context, splitter, places, whole,
                                 {static_cast<double>(mouse.x), static_cast<double>(mouse.y)});
  const double rounded = is_share ? std::round(wanted * 1e3) / 1e3 : std::round(wanted);
  const double least = is_share ? command.parameters[0].least : 1;
  context.perform(Call{&command, {std::clamp(rounded, least, command.parameters[0].greatest)}},
                  context.transient.gesture);
}

}  // namespace

void draw_splitters(const PaneContext& context, const Places& places, const PixelRect& whole) {
  const double reach = context.px(kReach);
  const auto upright = [&](const char* name, const char* command, double x, const PixelRect& beside) {
    use(context, {name, command, true, {x - reach, beside.top, 2 * reach, beside.height}}, places, whole);
  };
  if (places.left.width > 0) upright("splitter left", "left-width", places.left.right(), places.left);
  if (places.right.width > 0) upright("splitter right", "right-width", places.right.left, places.right);
  if (places.criteria.height > 0)
    use(context,
        {"splitter charts",
         "charts-height",
         false,
         {places.criteria.left, places.criteria.top - reach, places.criteria.width, 2 * reach}},
        places, whole);
  const Settings& settings = context.settings();
  const Layout layout = shown_layout(settings.layout, places.maps, context.scale);
  const MapPlaces maps = lay_out_maps(places.maps, context.scale, layout, settings.map_share);
  if (layout == Layout::kSideBySide)
    upright("splitter maps", "map-share", (maps.picture_a.right() + maps.picture_b.left) / 2, maps.picture_a);
  if (layout == Layout::kStacked)
    use(context,
        {"splitter maps",
         "map-share",
         false,
         {maps.picture_a.left, maps.picture_a.bottom() - reach / 2, maps.picture_a.width, 2 * reach}},
        places, whole);
}

}  // namespace sweepscope::ui
