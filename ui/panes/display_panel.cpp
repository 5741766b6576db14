#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/charts/ticks.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/host/paint.hpp"
#include "ui/panes/close_ups.hpp"
#include "ui/panes/number_box.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

const char* name_of(const Settings& settings) {
  if (settings.layout == Layout::kDifference) return "Distance from A [mm]";
  switch (settings.colouring) {
    case ColourBy::kIntensity:
      return "Intensity";
    case ColourBy::kTime:
      return "Time [s]";
    case ColourBy::kDirection:
      return "Motor turns to";
    case ColourBy::kBlur:
      return "Thickness of the surface [mm]";
    default:
      return "Elevation [m]";
  }
}

/// Edge and plane points have no order: their colours are named.
void feature_legend(const PaneContext& context) {
  for (const auto& [name, kind] :
       {std::pair{"edge points", FeatureKind::kEdge}, std::pair{"plane points", FeatureKind::kPlane},
        std::pair{"others", FeatureKind::kNone}}) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = context.pxf(10), y = at.y + (ImGui::GetTextLineHeight() - size) / 2;
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, y}, {at.x + size, y + size},
                                              to_imgui(colour_of_feature(kind)), context.pxf(2));
    ImGui::SetCursorScreenPos({at.x + context.pxf(18), at.y});
    ImGui::TextDisabled("%s", name);
  }
}

/// The colour table with the values that its ends stand for.
void legend(const PaneContext& context) {
  if (context.settings().colouring == ColourBy::kFeatures && context.settings().layout != Layout::kDifference)
    return feature_legend(context);
  const ColourTable table = shown_table(context.settings().table, backdrop_of(context).green >= 128);
  ImGui::TextUnformatted(name_of(context.settings()));
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = context.pxf(10);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr int kParts = 128;
  for (int i = 0; i < kParts; ++i) {
    const float x = from.x + width * static_cast<float>(i) / kParts;
    const float next = from.x + width * static_cast<float>(i + 1) / kParts;
    list.AddRectFilled({x, from.y}, {next, from.y + height},
                       to_imgui(table[std::size_t{2} * static_cast<std::size_t>(i)]));
  }
  const ColourSpan span = context.explorer.maps.shown_span();
  const double size = context.px(11);
  if (context.settings().colouring == ColourBy::kDirection &&
      context.settings().layout != Layout::kDifference) {
    for (const auto& [text, part, align] :
         {std::tuple{"lesser angles", 0.0, AlignX::kLeft}, std::tuple{"greater angles", 1.0, AlignX::kRight}})
      paint_text(list, context.fonts,
                 {static_cast<double>(from.x) + part * static_cast<double>(width),
                  static_cast<double>(from.y + height) + context.px(4)},
                 text, size, context.style.faint_text, align, AlignY::kTop);
  } else {
    const Ticks ticks = round_ticks(span.from, span.to, 5);
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
      const double part = (ticks.values[i] - span.from) / std::max(span.to - span.from, 1e-12);
      const double x = static_cast<double>(from.x) + part * static_cast<double>(width);
      const AlignX align = part < 0.06 ? AlignX::kLeft : part > 0.94 ? AlignX::kRight : AlignX::kCentre;
      list.AddLine({static_cast<float>(x), from.y + height},
                   {static_cast<float>(x), from.y + height + context.pxf(3)},
                   to_imgui(context.style.faint_text));
      paint_text(list, context.fonts, {x, static_cast<double>(from.y + height) + context.px(5)},
                 ticks.labels[i], size, context.style.faint_text, align, AlignY::kTop);
    }
  }
  ImGui::Dummy({width, height + context.pxf(20)});
}

/// The values at the ends of the colour table: those found from the maps, until a person sets others. What
/// has no order has none.
void colour_range(const PaneContext& context) {
  const Settings& settings = context.settings();
  const bool ordered =
      settings.colouring != ColourBy::kFeatures && settings.colouring != ColourBy::kDirection;
  if (!ordered && settings.layout != Layout::kDifference) return;
  const Command& command = *find_command("colour-range");
  begin_field(context, command);
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x,
              width = (ImGui::GetContentRegionAvail().x - gap) / 2;
  const ColourSpan span = context.explorer.maps.shown_span();
  for (const std::size_t end : {0, 1}) {
    if (end > 0) ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(width);
    NumberBox box = box_of(command, end);
    if (settings.colour_from == settings.colour_to) box.automatic = {span.from, span.to};
    number_box(context, box);
    context.anchor_last(fmt::format("colour-range {}", end));
    tooltip(context, command.help);
  }
}

/// How thick the surfaces of both maps are, while blur colours them. Until it is measured there is room for
/// it.
void map_thickness(const PaneContext& context) {
  if (context.settings().colouring != ColourBy::kBlur || context.settings().layout == Layout::kDifference)
    return;
  bool measuring = false;
  for (const auto& [map, name] : {std::pair{"A", "thickness-a"}, std::pair{"B", "thickness-b"}}) {
    const std::string words = observe(context.explorer, name).value_or("");
    if (words.empty() && context.explorer.at_rest()) continue;
    measuring = measuring || words.empty();
    if (words.empty())
      waiting_text(map + std::string(": measuring …"));
    else
      wrapped_text(context.style.faint_text, map + (": " + words));
  }
  wrapped_text(context.style.faint_text,
               measuring ? "Grey: no thickness known yet." : "Grey: no flat surface found.");
}

/// A bar for the whole recording with a handle at either end of the part that is shown.
void time_window(const PaneContext& context) {
  const double duration_s = context.explorer.loaded()->duration_s();
  const Settings& settings = context.settings();
  const bool all = settings.time_to_s <= settings.time_from_s;
  double from_s = all ? 0 : settings.time_from_s,
         to_s = all ? duration_s : std::min(settings.time_to_s, duration_s);
  ImGui::TextUnformatted("Time");
  const std::string words = all ? "all" : fmt::format("{:.1f} to {:.1f} s", from_s, to_s);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(words.c_str()).x);
  ImGui::TextDisabled("%s", words.c_str());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = context.pxf(16), r = context.pxf(6);
  ImGui::InvisibleButton("time-window", {width, height});
  context.anchor_last("time-window");
  tooltip(context, find_command("time-window")->help);
  const double room = static_cast<double>(width - 2 * r);
  const auto x_of = [&](double s) {
    return at.x + r + static_cast<float>(room * s / std::max(duration_s, 1e-9));
  };
  double& held = context.transient.time_handle;
  const double mouse_s =
      std::clamp(static_cast<double>(ImGui::GetIO().MousePos.x - at.x - r) / room, 0.0, 1.0) * duration_s;
  if (ImGui::IsItemActivated()) {
    context.begin_gesture();
    held = std::abs(mouse_s - from_s) <= std::abs(mouse_s - to_s) ? 0 : 1;
  }
  if (ImGui::IsItemActive()) {
    const double rounded_s = std::round(mouse_s * 20) / 20;
    if (held < 0.5)
      from_s = std::min(rounded_s, to_s - 0.05);
    else
      to_s = std::max(rounded_s, from_s + 0.05);
    const bool whole = from_s <= 0.05 && to_s >= duration_s - 0.05;
    context.perform(
        Call{find_command("time-window"), {whole ? 0.0 : std::max(0.0, from_s), whole ? 0.0 : to_s}},
        context.transient.gesture);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = at.y + height / 2, h = context.pxf(2);
  list.AddRectFilled({at.x + r, y - h}, {at.x + width - r, y + h}, to_imgui(context.style.frame), h);
  list.AddRectFilled({x_of(from_s), y - h}, {x_of(to_s), y + h}, to_imgui(colour_of_b(context.style)), h);
  for (const double end : {from_s, to_s})
    list.AddCircleFilled({x_of(end), y}, r, to_imgui(colour_of_b(context.style)));
}

/// A button that sets the box, and once there is one its corners.
void clipping_box(const PaneContext& context) {
  const Command& command = *find_command("box");
  begin_field(context, command);
  const bool any = context.settings().has_box();
  if (!any) {
    button(context, "To the view", "box-here");
    return;
  }
  button(context, "None", "box 0 0 0 0 0 0");
  const auto width =
      (ImGui::GetContentRegionAvail().x - context.pxf(20) - ImGui::GetStyle().ItemInnerSpacing.x) / 2;
  for (const std::size_t axis : {0, 1, 2}) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%c", static_cast<char>('x' + axis));
    ImGui::SameLine(ImGui::GetWindowContentRegionMin().x + context.pxf(20));
    for (const std::size_t end : {axis, axis + 3}) {
      if (end != axis) ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
      ImGui::SetNextItemWidth(width);
      number_box(context, box_of(command, end));
      context.anchor_last(fmt::format("box {}", end));
    }
  }
}

}  // namespace

void draw_display_panel(const PaneContext& context, const PixelRect& place, bool above) {
  if (place.width <= 0 || context.explorer.loaded() == nullptr) return;
  begin_panel(context, above ? "display above" : "display", place, true, above);
  const Settings& settings = context.settings();
  heading(context, "Maps", true);
  field(context, "layout");
  field(context, "linked");
  field(context, "perspective");
  heading(context, "Points");
  field(context, "colouring");
  field(context, "table");
  legend(context);
  colour_range(context);
  map_thickness(context);
  field(context, "point-size");
  field(context, "backdrop");
  field(context, "trajectory");
  heading(context, "Visible points");
  field(context, "heights");
  if (settings.heights == Heights::kSlab) field(context, "slab");
  time_window(context);
  clipping_box(context);
  heading(context, "Inspect");
  field(context, "tool");
  field(context, "scan-view");
  field(context, "close-up");
  place_field(context);
  heading(context, "Depth");
  for (const DepthCueOption& option : depth_cue_options()) field(context, option.name.c_str());
  end_panel();
}

}  // namespace sweepscope::ui
