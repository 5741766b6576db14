#include "ui/panes/number_box.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// As many decimals as the step needs.
int decimals_for(double step) {
  if (step <= 0) return 2;
  int decimals = 0;
  while (decimals < 4 && std::abs(step - std::round(step)) > 1e-9) step *= 10, ++decimals;
  return decimals;
}

/// As near to what was typed as the parameter's step allows a drag to set it.
double rounded(double number, const NumberBox& box) {
  const double step = box.step > 0 ? box.step : 1e-3;
  return std::clamp(std::round(std::round(number / step) * step * 1e6) / 1e6, box.least, box.greatest);
}

Call call_with(const PaneContext& context, const NumberBox& box, double number) {
  Call call{box.command, box.command->get(context.settings())};
  if (!box.automatic.empty()) call.values.assign(box.automatic.begin(), box.automatic.end());
  call.values[box.index] = number;
  return call;
}

double number_now(const PaneContext& context, const NumberBox& box) {
  if (!box.automatic.empty()) return box.automatic[box.index];
  return std::get<double>(box.command->get(context.settings())[box.index]);
}

void set_typed(const PaneContext& context, const NumberBox& box, const std::string& text) {
  const Parameter& parameter = box.command->parameters[box.index];
  const auto number = parse_typed_number(parameter, text);
  if (!number) return context.explorer.messages.error(number.error());
  if (*number != number_now(context, box)) context.perform(call_with(context, box, *number));
}

/// While it is typed into. Enter, Tab and a click elsewhere set the number, Escape leaves it as it was.
void typed_box(const PaneContext& context, const NumberBox& box) {
  Transient& transient = context.transient;
  Transient::Typing& typing = *transient.typing;
  if (!typing.begun) {
    typing.begun = true;
    typing.text = to_word(number_now(context, box));
    ImGui::SetKeyboardFocusHere();
  }
  const bool entered =
      ImGui::InputText(("##typed" + box.id).c_str(), &typing.text,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const bool left = typing.focused && !ImGui::IsItemActive();
  typing.focused = typing.focused || ImGui::IsItemActive();
  if (!entered && !left && !transient.type_next) return;
  const std::string text = typing.text;
  transient.typing.reset();
  set_typed(context, box, text);
}

/// A drag changes the number; a click that does not drag begins to type.
void dragged_box(const PaneContext& context, const NumberBox& box) {
  double number = number_now(context, box);
  const std::string id = "##" + box.id;
  ImGui::PushStyleColor(ImGuiCol_Text,
                        to_imgui(box.automatic.empty() ? context.style.text : context.style.faint_text));
  const bool edited =
      box.slider
          ? ImGui::SliderScalar(id.c_str(), ImGuiDataType_Double, &number, &box.least, &box.greatest,
                                box.format.c_str(), ImGuiSliderFlags_NoInput)
          : ImGui::DragScalar(id.c_str(), ImGuiDataType_Double, &number, static_cast<float>(box.per_px),
                              &box.least, &box.greatest, box.format.c_str(), ImGuiSliderFlags_NoInput);
  ImGui::PopStyleColor();
  if (ImGui::IsItemActivated()) context.begin_gesture();
  if (edited) context.perform(call_with(context, box, rounded(number, box)), context.transient.gesture);
  const ImGuiIO& io = ImGui::GetIO();
  const float moved2 = io.MouseDragMaxDistanceSqr[0];
  const bool clicked =
      ImGui::IsItemDeactivated() && moved2 < io.MouseDragThreshold * io.MouseDragThreshold / 4;
  const bool asked = ImGui::IsItemHovered() && (ImGui::IsMouseDoubleClicked(0) || (io.KeyCtrl && clicked));
  if (asked || (clicked && !box.slider)) context.transient.type_next = box.id;
}

}  // namespace

Result<double> parse_typed_number(const Parameter& parameter, std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  if (!parameter.unit.empty() && text.ends_with(parameter.unit)) text.remove_suffix(parameter.unit.size());
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  std::string word(text);
  // A decimal comma, unless it may separate thousands.
  if (std::count(word.begin(), word.end(), ',') == 1 && word.find('.') == std::string::npos)
    word[word.find(',')] = '.';
  if (const auto value = parse_value(parameter, word)) return std::get<double>(*value);
  const bool is_number = parse_value(Parameter(), word).has_value();
  return failure(ExitCode::kWrongUsage,
                 fmt::format("\"{}\" is {}. Type {}.", text, is_number ? "out of range" : "not a number",
                             describe(parameter)));
}

NumberBox box_of(const Command& command, std::size_t index) {
  const Parameter& parameter = command.parameters[index];
  const std::string unit = parameter.unit == "%" ? " %%" : parameter.unit.empty() ? "" : " " + parameter.unit;
  return {.id = fmt::format("{}{}", command.name, index),
          .command = &command,
          .index = index,
          .least = parameter.least,
          .greatest = parameter.greatest,
          .step = parameter.step,
          .per_px = std::max(parameter.step, 1e-3) * 0.2,
          .format = fmt::format("%.{}f{}", decimals_for(parameter.step), unit)};
}

void number_box(const PaneContext& context, const NumberBox& box) {
  Transient& transient = context.transient;
  transient.boxes.push_back(box.id);
  if (transient.typing && transient.typing->box == box.id)
    typed_box(context, box);
  else
    dragged_box(context, box);
}

void begin_number_boxes(Transient& transient) {
  const auto& boxes = transient.boxes;
  const bool gone = transient.typing && transient.typing->begun &&
                    std::find(boxes.begin(), boxes.end(), transient.typing->box) == boxes.end();
  if (gone) transient.typing.reset();
  // What is typed into now sets its number first, in this frame.
  if (transient.type_next && !transient.typing) {
    transient.typing = Transient::Typing{*transient.type_next, "", false, false};
    transient.type_next.reset();
  }
  transient.boxes.clear();
}

void type_into_next_box(Transient& transient, int way) {
  const std::vector<std::string>& boxes = transient.boxes;
  if (boxes.empty()) return;
  const std::string from = transient.typing ? transient.typing->box : "";
  const auto at = std::find(boxes.begin(), boxes.end(), from);
  const auto count = static_cast<std::ptrdiff_t>(boxes.size());
  // The offset of map A comes first, wherever it is on the screen.
  const auto first = std::find(boxes.begin(), boxes.end(), "offset-a0");
  const std::ptrdiff_t next = at != boxes.end()      ? at - boxes.begin() + way
                              : first != boxes.end() ? first - boxes.begin()
                                                     : 0;
  transient.type_next = boxes[static_cast<std::size_t>((next + count) % count)];
}

}  // namespace sweepscope::ui
