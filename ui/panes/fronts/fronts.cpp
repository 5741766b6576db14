#include <fmt/format.h>
#include <imgui.h>

#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "core/io/printable_text.hpp"
#include "ui/host/input.hpp"
#include "ui/panes/fronts/figure_dialog.hpp"
#include "ui/panes/fronts/file_dialog.hpp"
#include "ui/panes/fronts/fronts.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// What a shortcut does, for a person.
std::string title_of(const Shortcut& shortcut) {
  if (!shortcut.title.empty()) return shortcut.title;
  for (const MenuItem& item : menu_items()) {
    if (item.line == shortcut.line) return item.title;
  }
  return find_command(shortcut.line.substr(0, shortcut.line.find(' ')))->title;
}

/// As the menu has it, or what the command says.
std::string title_of_asking(const Transient::Asked& asked) {
  const std::string line = "ask " + asked.command + (asked.what.empty() ? "" : " " + asked.what);
  for (const MenuItem& item : menu_items()) {
    if (item.line == line) return item.title.substr(0, item.title.find(" …"));
  }
  return find_command(asked.command)->title;
}

struct Entry {
  std::string title, line, chord;
  bool takes_words = false;  // the line is completed in the palette before it is run
};

/// A line for each value of a choice that no menu has.
void add_choices(std::vector<Entry>& entries, const Command& command) {
  constexpr std::size_t kMaxChoices = 6;  // of more, the command alone
  const auto& choices = command.parameters[0].choices;
  if (choices.size() > kMaxChoices) return;
  for (const std::string& choice : choices) {
    const std::string line = command.name + " " + choice;
    const bool known = std::ranges::any_of(entries, [&](const Entry& entry) { return entry.line == line; });
    if (!known)
      entries.push_back({command.title + ": " + choice_in_words(choice), line, chord_of(line), false});
  }
}

std::vector<Entry> all_entries(const std::vector<std::string>& recent) {
  std::vector<Entry> entries;
  for (const std::string& path : recent)
    entries.push_back({"Open " + printable_line(std::filesystem::path(path).filename().string()),
                       "open " + ui::quoted(path), "", false});
  for (const MenuItem& item : menu_items()) {
    if (!item.line.empty()) entries.push_back({item.title, item.line, chord_of(item.line), false});
  }
  for (const Command& command : commands()) {
    const bool plain = command.parameters.empty();
    if (plain &&
        std::any_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.line == command.name; }))
      continue;
    std::string usage;
    for (const Parameter& parameter : command.parameters) usage += " " + parameter.name;
    entries.push_back({command.title + usage, command.name, chord_of(command.name), !plain});
    if (command.is_field() && command.parameters.size() == 1) add_choices(entries, command);
  }
  return entries;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool has_words(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::all_of(words,
                             [&](const std::string& word) { return text.find(lower(word)) != text.npos; });
}

/// The entries in which every word of the query occurs; first those that it names, then those that have
/// another name like it.
std::vector<Entry> matching(std::vector<Entry> entries, const std::string& query) {
  const auto words = split_words(query);
  if (!words) return {};
  const auto name = [](const Entry& entry) { return lower(entry.title + " " + entry.line); };
  std::erase_if(entries, [&](const Entry& entry) {
    return !has_words(name(entry) + " " + std::string(synonyms_of(entry.line)), *words);
  });
  std::ranges::stable_partition(entries, [&](const Entry& entry) { return has_words(name(entry), *words); });
  return entries;
}

void run_entry(const PaneContext& context, const Entry& entry) {
  if (entry.takes_words) {
    context.transient.palette_query = entry.line + " ";
    context.transient.just_opened = true;
    return;
  }
  context.transient.palette = false;
  context.perform(entry.line);
}

/// As typed, but what would replace a file asks first.
void perform_or_ask(const PaneContext& context, const std::string& line) {
  const Call call = *parse_call(line);
  const std::string replaced = context.explorer.files.replaced_by(call);
  if (replaced.empty()) return context.perform(call);
  const std::string& command = call.command->name;
  const bool cloud = command == "export-cloud";
  Transient& transient = context.transient;
  transient.asks_for = Transient::Asked{command, call.text(cloud ? 0 : 1)};
  transient.asked_text = call.text(cloud ? 1 : 0);
  transient.replaces = replaced;
  transient.just_opened = true;
}

/// A whole command with its arguments was typed: it is run as it stands.
bool run_typed(const PaneContext& context) {
  if (!parse_call(context.transient.palette_query)) return false;
  const std::string line = context.transient.palette_query;
  context.transient.palette = false;
  perform_or_ask(context, line);
  return true;
}

void palette_list(const PaneContext& context, const std::vector<Entry>& found) {
  Transient& transient = context.transient;
  ImGui::BeginChild("found");
  const float right = ImGui::GetWindowContentRegionMax().x;
  const bool narrow = right < context.pxf(460);  // titles alone, and keys beside short ones
  const auto width_of = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool chosen = static_cast<int>(i) == transient.palette_choice;
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(found[i].title.c_str(), chosen)) run_entry(context, found[i]);
    if (chosen) ImGui::SetScrollHereY(0.5f);
    context.anchor_last("palette " + found[i].line);
    if (!narrow) {
      ImGui::SameLine(right * 0.62f);
      ImGui::TextDisabled("%s", found[i].line.c_str());
    }
    const float chord = right - width_of(found[i].chord) - context.pxf(4);
    if (!found[i].chord.empty() && (!narrow || width_of(found[i].title) + context.pxf(12) < chord)) {
      ImGui::SameLine(chord);
      ImGui::TextUnformatted(found[i].chord.c_str());
    }
    ImGui::PopID();
  }
  if (found.empty())
    ImGui::TextDisabled("No command matches. Enter runs a whole line, such as \"offset-a 19\".");
  ImGui::EndChild();
}

}  // namespace

void begin_front(const PaneContext& context, const char* name, const PixelRect& whole, double width,
                 double height, double from_top) {
  const double w = std::min(context.px(width), whole.width - context.px(24));
  const double h = std::min(context.px(height), whole.height - context.px(24));
  const double top =
      std::max(context.px(12), std::min(whole.height * from_top, whole.height - h - context.px(12)));
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(extent(whole));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(0, 0, 0, 110));
  ImGui::Begin((std::string(name) + " veil").c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) context.perform("dismiss");
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::SetNextWindowPos(vec(std::round((whole.width - w) / 2), std::round(top)));
  ImGui::SetNextWindowSize(vec(w, h));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(context.pxf(18), context.pxf(16)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, context.pxf(6));
  if (context.transient.just_opened) ImGui::SetNextWindowFocus();
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(3);
  ImGui::PopStyleColor();
}

void draw_palette(const PaneContext& context, const PixelRect& whole) {
  Transient& transient = context.transient;
  if (!transient.palette) return;
  begin_front(context, "palette", whole, 660, 420, 0.1);
  const std::string before = transient.palette_query;
  std::vector<Entry> found = matching(all_entries(transient.recent), before);
  const int last = std::max(0, static_cast<int>(found.size()) - 1);
  if (ImGui::IsKeyPressed(keys::kDown)) ++transient.palette_choice;
  if (ImGui::IsKeyPressed(keys::kUp)) --transient.palette_choice;
  transient.palette_choice = std::clamp(transient.palette_choice, 0, last);
  if (transient.just_opened) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1e-3f);
  const bool entered = ImGui::InputTextWithHint(
      "##query", "Search, or type a command", &transient.palette_query, ImGuiInputTextFlags_EnterReturnsTrue);
  if (transient.palette_query != before) {  // Enter may come in the same frame
    transient.palette_choice = 0;
    found = matching(all_entries(transient.recent), transient.palette_query);
  }
  ImGui::Dummy({0, context.pxf(2)});
  palette_list(context, found);
  ImGui::End();
  if (!entered || run_typed(context)) return;
  if (!found.empty())
    run_entry(context, found[static_cast<std::size_t>(transient.palette_choice)]);
  else
    context.perform(transient.palette_query);
}

void draw_help(const PaneContext& context, const PixelRect& whole) {
  if (!context.transient.help) return;
  begin_front(context, "keys", whole, 940, 540, 0.1);
  text_in(context.fonts.heading, "Keys");
  wrapped_text(
      context.style.faint_text,
      "Drag to turn, drag with the right button or Shift to move, wheel to zoom. Every command: Ctrl+P.");
  ImGui::Dummy({0, context.pxf(4)});
  constexpr float kChord = 88, kTitle = 200;
  const auto all = shortcuts();
  // At 200 % or in a small window fewer fit beside each other, and the list scrolls.
  const float fitting = ImGui::GetContentRegionAvail().x / context.pxf(kChord + kTitle);
  const std::size_t columns = std::clamp<std::size_t>(static_cast<std::size_t>(fitting), 1, 3);
  const std::size_t rows = (all.size() + columns - 1) / columns;
  ImGui::PushFont(context.fonts.small);
  const ImVec2 rest(0, ImGui::GetContentRegionAvail().y);
  if (ImGui::BeginTable("keys", static_cast<int>(2 * columns),
                        ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY, rest)) {
    for (std::size_t i = 0; i < columns; ++i)
      for (const float width : {kChord, kTitle})
        ImGui::TableSetupColumn("", 0, width * static_cast<float>(context.scale));
    for (std::size_t r = 0; r < rows; ++r) {
      ImGui::TableNextRow(0, context.pxf(17));
      for (std::size_t i = r; i < columns * rows; i += rows) {
        ImGui::TableNextColumn();
        if (i < all.size()) ImGui::TextUnformatted(all[i].chord.c_str());
        ImGui::TableNextColumn();
        if (i >= all.size()) continue;
        ImGui::TextDisabled("%s", title_of(all[i]).c_str());
      }
    }
    ImGui::EndTable();
  }
  ImGui::PopFont();
  ImGui::End();
}

namespace {

/// The line that does what was asked for.
std::string line_of_asking(const Transient::Asked& asked, const std::string& text) {
  const std::string file = ui::quoted(without_tilde(text, home_folder()));
  if (asked.command == "export-cloud")
    return fmt::format("export-cloud {} {}", asked.what == "a" ? "a" : "b", file);
  if (asked.command == "export-picture" && !asked.what.empty())
    return fmt::format("export-picture {} {}", file, asked.what);
  return asked.command + " " + file;
}

/// The file, what happens to it, and the buttons. Whether it was confirmed.
bool ask_for_file(const PaneContext& context, const Transient::Asked& asked) {
  Transient& transient = context.transient;
  const bool folder = asked.command == "export-report";
  if (transient.just_opened) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1e-3f);
  const std::string before = transient.asked_text;
  const bool entered =
      ImGui::InputTextWithHint("##file", folder ? "A folder" : "A file", &transient.asked_text,
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  context.anchor_last("ask file");
  if (transient.asked_text != before) transient.replaces.clear();
  if (!transient.asked_text.empty()) {
    const bool is_new = transient.replaces.empty();
    const std::string says = is_new ? whole_path(without_tilde(transient.asked_text, home_folder()))
                                    : transient.replaces + " already exists. Press Enter to replace it.";
    wrapped_text(is_new ? context.style.faint_text : colour_of_a(context.style), printable_line(says));
  }
  ImGui::Dummy({0, context.pxf(2)});
  const bool confirmed =
      ImGui::Button(transient.replaces.empty() ? "OK##ok" : "Replace##ok", {context.pxf(100), 0});
  context.anchor_last("button ok");
  return entered || confirmed;
}

}  // namespace

void draw_ask(const PaneContext& context, const PixelRect& whole) {
  Transient& transient = context.transient;
  if (!transient.asks_for) return;
  const Transient::Asked asked = *transient.asks_for;
  if (is_opening(asked.command)) return draw_open_dialog(context, whole);
  const bool figure = asked.command == "export-figure";
  begin_front(context, "ask", whole, figure ? 880 : 560, figure ? 560 : 206, figure ? 0.08 : 0.22);
  text_in(context.fonts.heading, title_of_asking(asked));
  if (figure)
    draw_figure_options(context);
  else
    wrapped_text(context.style.faint_text, find_command(asked.command)->help);
  const bool confirmed = ask_for_file(context, asked);
  ImGui::SameLine();
  const bool dismissed = ImGui::Button("Cancel", {context.pxf(100), 0});
  context.anchor_last("button cancel-asking");
  ImGui::End();
  if (dismissed) return context.perform("dismiss");
  if (!confirmed || transient.asked_text.empty() || !transient.asks_for) return;
  const std::string line =
      figure ? figure_line(transient, ui::quoted(without_tilde(transient.asked_text, home_folder())))
             : line_of_asking(asked, transient.asked_text);
  const auto call = parse_call(line);
  if (call && transient.replaces.empty()) {
    transient.replaces = context.explorer.files.replaced_by(*call);
    transient.just_opened = !transient.replaces.empty();  // Enter left the field
    if (transient.just_opened) return;
  }
  transient.asks_for.reset();
  context.perform(line);
}

namespace {

constexpr double kMessageMargin = 9, kDismissWidth = 110;  // at 100 %

float message_wrap(const PaneContext& context, double width_px) {
  return static_cast<float>(width_px - context.px(kMessageMargin + 20 + kDismissWidth));
}

std::string message_text(const Message& message) {
  return without_options(printable_message(message.text));
}

}  // namespace

double message_height(const PaneContext& context, double width_px) {
  const auto& message = context.explorer.messages.shown();
  if (!message) return 0;
  ImGui::PushFont(context.fonts.body);
  const auto text = static_cast<double>(
      ImGui::CalcTextSize(message_text(*message).c_str(), nullptr, false, message_wrap(context, width_px)).y);
  ImGui::PopFont();
  return text + context.px(2 * kMessageMargin);
}

void draw_message(const PaneContext& context, const PixelRect& place) {
  const auto& message = context.explorer.messages.shown();
  if (!message) return;
  const bool error = message->kind == Message::Kind::kError;
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  begin_panel(context, "message", place, false, true);
  ImGui::PopStyleColor();
  const Colour mark = error ? colour_of_a(context.style) : colour_of_b(context.style);
  const auto left = static_cast<float>(place.left), top = static_cast<float>(place.top);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({left, top}, {left + context.pxf(4), static_cast<float>(place.bottom())},
                     to_imgui(mark));
  list.AddLine({left, top}, {static_cast<float>(place.right()), top}, to_imgui(context.style.frame));
  ImGui::SetCursorPos({context.pxf(14), context.pxf(kMessageMargin)});
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + message_wrap(context, place.width));
  ImGui::TextUnformatted(message_text(*message).c_str());
  ImGui::PopTextWrapPos();
  ImGui::SetCursorPos(
      {static_cast<float>(place.width) - context.pxf(kDismissWidth - 20), context.pxf(kMessageMargin)});
  const bool dismissed = ImGui::SmallButton("Dismiss");
  context.anchor_last("button dismiss");
  context.anchor("message", place);
  context.explorer.messages.hold(ImGui::IsWindowHovered());
  end_panel();
  if (dismissed) context.explorer.messages.dismiss();  // not "dismiss": that is for what is in front of it
}

}  // namespace sweepscope::ui
