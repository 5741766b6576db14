#include "ui/panes/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/io/printable_text.hpp"
#include "ui/panes/number_box.hpp"

namespace sweepscope::ui {
namespace {

void choice_field(const PaneContext& context, const Command& command) {
  begin_field(context, command);
  const std::string now = to_word(command.get(context.settings())[0]);
  if (ImGui::BeginCombo(("##" + command.name).c_str(), choice_in_words(now).c_str())) {
    for (const std::string& choice : command.parameters[0].choices) {
      if (ImGui::Selectable(choice_in_words(choice).c_str(), choice == now))
        context.perform(command.name + " " + choice);
      if (choice == now) ImGui::SetItemDefaultFocus();  // where the arrows begin
      context.anchor_last(command.name + " " + choice);
    }
    ImGui::EndCombo();
  }
}

void switch_field(const PaneContext& context, const Command& command) {
  begin_field(context, command);
  bool on = std::get<bool>(command.get(context.settings())[0]);
  if (ImGui::Checkbox(("##" + command.name).c_str(), &on))
    context.perform(command.name + (on ? " on" : " off"));
}

/// One slider, or drag boxes side by side where there are several numbers.
void number_field(const PaneContext& context, const Command& command) {
  begin_field(context, command);
  const std::vector<Value> values = command.get(context.settings());
  const auto count = static_cast<float>(values.size());
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - gap * (count - 1)) / count;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& parameter = command.parameters[i];
    if (i > 0) ImGui::SameLine(0, gap);
    ImGui::SetNextItemWidth(width);
    NumberBox box = box_of(command, i);
    box.slider = values.size() == 1 && parameter.greatest - parameter.least < 100;
    number_box(context, box);
  }
}

}  // namespace

std::string choice_in_words(std::string word) {
  if (word == "sharp") return "Blur shows";  // as much as the field is wide
  std::replace(word.begin(), word.end(), '-', ' ');
  for (std::size_t at = 0; (at = word.find(',', at)) != word.npos; at += 2) word.replace(at, 1, ", ");
  if (!word.empty() && word[0] >= 'a' && word[0] <= 'z') word[0] = static_cast<char>(word[0] - 'a' + 'A');
  return word;
}

PixelPoint mouse() {
  const ImVec2 at = ImGui::GetIO().MousePos;
  return {static_cast<double>(at.x), static_cast<double>(at.y)};
}

int held_button() {
  return ImGui::IsMouseDown(0) ? 0 : ImGui::IsMouseDown(1) ? 1 : 2;
}

bool is_dragged(const PaneContext& context, int button) {
  constexpr double kTremble = 4;
  const float tremble = context.pxf(kTremble);
  return ImGui::GetIO().MouseDragMaxDistanceSqr[button] >= tremble * tremble;
}

void PaneContext::perform(const std::string& line, const std::string& gesture) const {
  if (const auto done = explorer.perform(line, gesture); !done) explorer.messages.error(done.error());
}

void PaneContext::perform(const Call& call, const std::string& gesture) const {
  if (const auto done = explorer.perform(call, gesture); !done) explorer.messages.error(done.error());
}

std::string PaneContext::begin_gesture() const {
  transient.gesture = "drag " + std::to_string(++transient.gestures);
  return transient.gesture;
}

void PaneContext::anchor_last(const std::string& name) const {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  anchor(name, {from.x, from.y, to.x - from.x, to.y - from.y});
}

void begin_panel(const PaneContext& context, const char* name, const PixelRect& place, bool padded,
                 bool above, bool by_keys) {
  ImGui::SetNextWindowPos(corner(place));
  ImGui::SetNextWindowSize(extent(place));
  const float margin = padded ? context.pxf(kPanelMargin) : 0;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(margin, padded ? context.pxf(10) : 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  // The frame begins with the background of what lies at its bottom: to fill it again takes milliseconds.
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   (above ? 0 : ImGuiWindowFlags_NoBackground) | (padded ? 0 : ImGuiWindowFlags_NoScrollbar) |
                   (by_keys ? 0 : ImGuiWindowFlags_NoNav) |
                   (above ? ImGuiWindowFlags_NoFocusOnAppearing : ImGuiWindowFlags_NoBringToFrontOnFocus));
  ImGui::PopStyleVar(2);
}

void end_panel() {
  ImGui::End();
}

bool invisible_button(const std::string& name, const PixelRect& place, ImGuiButtonFlags flags) {
  ImGui::SetCursorScreenPos(corner(place));
  return ImGui::InvisibleButton(name.c_str(), extent(place), flags);
}

void text_in(ImFont* font, const std::string& text) {
  ImGui::PushFont(font);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
}

namespace {

/// Whether a line may not end before this word: a unit, or what follows a sign.
bool belongs_to(const std::string& before, std::string_view word) {
  while (!word.empty() && std::string_view(".,;:)").find(word.back()) != word.npos) word.remove_suffix(1);
  constexpr std::array kUnits{"mm", "cm", "m", "ms", "s", "%", "Hz", "deg", "°/s", "rad", "ppm", "px"};
  const bool number = !before.empty() && std::isdigit(static_cast<unsigned char>(before.back()));
  return before.ends_with("±") ||
         (number && (word == "±" || std::ranges::find(kUnits, word) != kUnits.end()));
}

}  // namespace

std::string in_lines(const std::string& text, float width_px) {
  std::vector<std::string> pieces;  // that are not broken
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (!pieces.empty() && belongs_to(pieces.back(), word))
      pieces.back() += " " + word;
    else
      pieces.push_back(word);
    from = to + 1;
  }
  std::string lines, line;
  for (const std::string& piece : pieces) {
    const std::string longer = line.empty() ? piece : line + " " + piece;
    const bool fits = ImGui::CalcTextSize(longer.c_str()).x <= width_px;
    if (!fits && !line.empty()) lines += line + "\n";
    line = fits ? longer : piece;
  }
  return lines + line;
}

void wrapped_text(const std::string& text) {
  ImGui::TextWrapped("%s", in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
}

void wrapped_text(const Colour& colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(colour));
  wrapped_text(text);
  ImGui::PopStyleColor();
}

void waiting_text(const std::string& text) {
  const float below =
      ImGui::GetCursorPosY() + 2 * ImGui::GetTextLineHeight() + ImGui::GetStyle().ItemSpacing.y;
  ImGui::TextDisabled("%s", text.c_str());
  ImGui::SetCursorPosY(below);
}

void small_print(const PaneContext& context, const std::string& text) {
  ImGui::PushFont(context.fonts.small);
  wrapped_text(context.style.faint_text, text);
  ImGui::PopFont();
}

void heading(const PaneContext& context, const char* text, bool first) {
  if (!first) {
    ImGui::Dummy({0, context.pxf(5)});
    const ImVec2 from = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine(from, {from.x + ImGui::GetContentRegionAvail().x, from.y},
                                        to_imgui(context.style.frame));
    ImGui::Dummy({0, context.pxf(6)});
  }
  ImGui::PushFont(context.fonts.bold);
  wrapped_text(text);
  ImGui::PopFont();
}

void row(const PaneContext& context, const char* name, const std::string& value) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(context.pxf(8), context.pxf(4)));
  ImGui::TextDisabled("%s", name);
  ImGui::SameLine(ImGui::GetWindowContentRegionMin().x + context.pxf(78));
  wrapped_text(printable_line(value));
  ImGui::PopStyleVar();
}

void begin_field(const PaneContext& context, const Command& command) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(command.title.c_str());
  tooltip(context, command.help);
  const float column = ImGui::GetWindowContentRegionMin().x + ImGui::GetWindowContentRegionWidth() * 0.46f;
  ImGui::SameLine(column);
  ImGui::SetNextItemWidth(-1e-3f);
}

void field(const PaneContext& context, const char* name) {
  const Command& command = *find_command(name);
  switch (command.parameters[0].kind) {
    case Kind::kChoice:
      choice_field(context, command);
      break;
    case Kind::kSwitch:
      switch_field(context, command);
      break;
    case Kind::kNumber:
      number_field(context, command);
      break;
    case Kind::kText:
      break;
  }
  context.anchor_last(command.name);
  tooltip(context, command.help);
}

bool button(const PaneContext& context, const char* title, const std::string& line, double width_px,
            bool primary) {
  const float width = width_px > 0 ? static_cast<float>(width_px) : -1e-3f;
  if (primary) {
    const Colour fill = colour_of_b(context.style);
    ImGui::PushStyleColor(ImGuiCol_Button, to_imgui(fill));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, to_imgui(fill, 0.85));
    ImGui::PushStyleColor(ImGuiCol_ButtonActive, to_imgui(fill, 0.7));
    ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(context.style.page));
  }
  const bool pressed = ImGui::Button((std::string(title) + "##" + line).c_str(), {width, 0});
  if (primary) ImGui::PopStyleColor(4);
  context.anchor_last("button " + line);
  if (pressed) context.perform(line);
  if (const Command* command = find_command(line.substr(0, line.find(' ')))) {
    const std::string chord = chord_of(line);
    tooltip(context, command->help + (chord.empty() ? "" : "  [" + chord + "]"));
  }
  return pressed;
}

void hint_buttons(const PaneContext& context, const std::vector<Hint>& hints) {
  for (const Hint& hint : hints) button(context, hint.title.c_str(), hint.line);
}

void tooltip(const PaneContext& context, const std::string& text, TooltipPlace place) {
  constexpr float kDelay_s = 0.5f;
  if (!ImGui::IsItemHovered() || context.transient.handle || context.transient.for_picture) return;
  // ImGui 1.86 has no delay of its own.
  ImGuiID& resting_on = context.transient.resting_on;
  double& since_s = context.transient.resting_since_s;
  const ImGuiID id = ImGui::GetID((text + std::to_string(ImGui::GetItemRectMin().y)).c_str());
  if (id != resting_on) {
    resting_on = id;
    since_s = ImGui::GetTime();
  }
  if (ImGui::GetTime() - since_s < static_cast<double>(kDelay_s)) return;
  if (place == TooltipPlace::kBelow)
    ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y + context.pxf(4)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(context.pxf(10), context.pxf(7)));
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(context.pxf(330));
  ImGui::TextUnformatted(printable_text(text).c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

void progress_bar(const PaneContext& context, double fraction, double width_px) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = width_px > 0 ? static_cast<float>(width_px) : ImGui::GetContentRegionAvail().x;
  const float height = context.pxf(5);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float done = width * static_cast<float>(std::clamp(fraction, 0.0, 1.0));
  list.AddRectFilled(from, {from.x + width, from.y + height}, to_imgui(context.style.frame), height / 2);
  if (done > height)
    list.AddRectFilled(from, {from.x + done, from.y + height}, to_imgui(colour_of_b(context.style)),
                       height / 2);
  ImGui::Dummy({width, height});
}

std::string time_left(double seconds) {
  if (seconds < 0) return "";
  const auto whole = static_cast<long>(std::ceil(seconds));
  return fmt::format("{}:{:02} left", whole / 60, whole % 60);
}

}  // namespace sweepscope::ui
