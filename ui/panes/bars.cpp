#include <fmt/format.h>

#include "core/io/printable_text.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// What a menu entry's tick says: whether its line is what the settings are already.
bool holds(const Settings& settings, const std::string& line) {
  const auto call = parse_call(line);
  if (!call || !call->command->is_field()) return false;
  const auto now = call->command->get(settings);
  if (call->values.empty()) return now.size() == 1 && now[0] == Value(true);
  return now == call->values;
}

bool makes_sense(const Explorer& explorer, const std::string& line) {
  static const std::vector<std::string> kAlways{"ask open", "sample", "quit", "palette", "help", "theme"};
  if (line == "ask export-report") return explorer.loaded() != nullptr && !explorer.is_exporting();
  if (line == "undo") return explorer.can_undo();
  if (line == "redo") return explorer.can_redo();
  if (line == "take-found") return explorer.estimate() != nullptr && explorer.estimate()->offset_s;
  if (line == "ask export-curve") return explorer.estimate() != nullptr;
  if (explorer.loaded() != nullptr) return true;
  return std::any_of(kAlways.begin(), kAlways.end(),
                     [&](const std::string& always) { return line.starts_with(always); });
}

void menu(const PaneContext& context, const std::string& name) {
  if (!ImGui::BeginMenu(name.c_str())) {
    context.anchor_last("menu " + name);
    return;
  }
  for (const MenuItem& item : menu_items()) {
    if (item.menu != name) continue;
    if (item.line.empty()) {
      ImGui::Separator();
      continue;
    }
    const std::string chord = chord_of(item.line);
    if (ImGui::MenuItem(item.title.c_str(), chord.c_str(), holds(context.settings(), item.line),
                        makes_sense(context.explorer, item.line)))
      context.perform(item.line);
    context.anchor_last("menu " + item.line);
  }
  ImGui::EndMenu();
}

/// The recording's name, in the middle of the bar.
void title(const PaneContext& context, const PixelRect& place) {
  const Loaded* loaded = context.explorer.loaded();
  const std::string text = loaded != nullptr ? printable_line(loaded->recording.name) : "sweepscope";
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImGui::GetWindowDrawList()->AddText(
      {static_cast<float>(place.left + (place.width - static_cast<double>(size.x)) / 2),
       static_cast<float>(place.top + (place.height - static_cast<double>(size.y)) / 2)},
      to_imgui(context.style.faint_text), text.c_str());
}

}  // namespace

void draw_menu_bar(const PaneContext& context, const PixelRect& place) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(context.pxf(8), context.pxf(7)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(context.pxf(8), context.pxf(6)));
  if (ImGui::BeginMainMenuBar()) {
    std::string last;
    for (const MenuItem& item : menu_items()) {
      if (item.menu != last) menu(context, item.menu);
      last = item.menu;
    }
    title(context, place);
    const float y = static_cast<float>(place.bottom()) - 1;
    ImGui::GetWindowDrawList()->AddLine({0, y}, {static_cast<float>(place.right()), y},
                                        to_imgui(context.style.frame));
    ImGui::EndMainMenuBar();
  }
  ImGui::PopStyleVar(2);
}

void draw_status_bar(const PaneContext& context, const PixelRect& place) {
  begin_panel(context, "status", place, false);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddLine({static_cast<float>(place.left), static_cast<float>(place.top)},
               {static_cast<float>(place.right()), static_cast<float>(place.top)},
               to_imgui(context.style.frame));
  ImGui::PushFont(context.fonts.small);
  const std::string equation = "t_motor = t_laser + offset";
  const double equation_width = static_cast<double>(ImGui::CalcTextSize(equation.c_str()).x);
  const auto y =
      static_cast<float>(place.top + (place.height - static_cast<double>(ImGui::GetFontSize())) / 2);
  const std::string status = context.explorer.status();
  const double room = place.width - context.px(14) * 3 - equation_width;
  list.PushClipRect(
      {static_cast<float>(place.left), static_cast<float>(place.top)},
      {static_cast<float>(place.left + context.px(14) + room), static_cast<float>(place.bottom())});
  list.AddText({context.pxf(14), y}, to_imgui(context.style.text), status.c_str());
  list.PopClipRect();
  list.AddText({static_cast<float>(place.right() - context.px(14) - equation_width), y},
               to_imgui(context.style.faint_text), equation.c_str());
  ImGui::PopFont();
  end_panel();
}

}  // namespace sweepscope::ui
