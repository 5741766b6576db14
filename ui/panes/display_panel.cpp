#include <fmt/format.h>

#include "render/ticks.hpp"
#include "ui/host/paint.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

const char* name_of(const Settings& settings) {
  if (settings.layout == Layout::kDifference) return "Distance from A [mm]";
  switch (settings.colouring) {
    case Colouring::kElevation:
      return "Elevation [m]";
    case Colouring::kIntensity:
      return "Intensity";
    case Colouring::kTime:
      return "Time [s]";
    case Colouring::kDirection:
      return "Motor's direction";
  }
  return "";
}

/// The colour table with the values that its ends stand for.
void legend(const PaneContext& context) {
  const auto table = colour_table(context.settings().table);
  if (!table) return;
  ImGui::TextUnformatted(name_of(context.settings()));
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = context.pxf(10);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr int kParts = 128;
  for (int i = 0; i < kParts; ++i) {
    const float x = from.x + width * static_cast<float>(i) / kParts;
    const float next = from.x + width * static_cast<float>(i + 1) / kParts;
    list.AddRectFilled({x, from.y}, {next, from.y + height},
                       to_imgui((*table)[static_cast<std::size_t>(2 * i)]));
  }
  const ColourSpan span = context.explorer.shown_span();
  const double size = context.px(11);
  if (context.settings().colouring == Colouring::kDirection &&
      context.settings().layout != Layout::kDifference) {
    for (const auto& [text, part, align] :
         {std::tuple{"to lesser angles", 0.0, AlignX::kLeft}, std::tuple{"to greater", 1.0, AlignX::kRight}})
      paint_text(list,
                 {{static_cast<double>(from.x) + part * static_cast<double>(width),
                   static_cast<double>(from.y + height) + context.px(4)},
                  text,
                  size,
                  context.style.faint_text,
                  align,
                  AlignY::kTop},
                 context.fonts);
  } else {
    const Ticks ticks = round_ticks(span.from, span.to, 5);
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
      const double part = (ticks.values[i] - span.from) / std::max(span.to - span.from, 1e-12);
      const double x = static_cast<double>(from.x) + part * static_cast<double>(width);
      const AlignX align = part < 0.06 ? AlignX::kLeft : part > 0.94 ? AlignX::kRight : AlignX::kCentre;
      list.AddLine({static_cast<float>(x), from.y + height},
                   {static_cast<float>(x), from.y + height + context.pxf(3)},
                   to_imgui(context.style.faint_text));
      paint_text(list,
                 {{x, static_cast<double>(from.y + height) + context.px(5)},
                  ticks.labels[i],
                  size,
                  context.style.faint_text,
                  align,
                  AlignY::kTop},
                 context.fonts);
    }
  }
  ImGui::Dummy({width, height + context.pxf(20)});
}

}  // namespace

void draw_display_panel(const PaneContext& context, const PixelRect& place) {
  if (place.width <= 0 || context.explorer.loaded() == nullptr) return;
  begin_panel(context, "display", place);
  const Settings& settings = context.settings();
  heading(context, "Maps", true);
  field(context, "layout");
  field(context, "linked");
  field(context, "perspective");
  heading(context, "Points");
  field(context, "colouring");
  field(context, "table");
  legend(context);
  field(context, "point-size");
  field(context, "backdrop");
  field(context, "trajectory");
  heading(context, "What is shown");
  field(context, "heights");
  if (settings.heights == Heights::kSlab) field(context, "slab");
  field(context, "time-window");
  heading(context, "Looking closely");
  field(context, "tool");
  field(context, "scan-view");
  end_panel();
}

}  // namespace sweepscope::ui
