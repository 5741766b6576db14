#include "ui/panes/fronts/file_dialog.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "core/io/printable_text.hpp"
#include "ui/host/input.hpp"
#include "ui/panes/fronts/fronts.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

namespace fs = std::filesystem;

/// The entries that the typed path leads to. The folder is read when it is another one than before.
std::vector<FileEntry> entries_now(Transient& transient, const FileRoots& roots) {
  Transient::Browsing& browsing = transient.browsing;
  const TypedPath typed = split_typed(transient.asked_text);
  const std::string folder = without_tilde(typed.folder, home_folder());
  if (!browsing.known || browsing.folder != folder) {
    const fs::path here = folder.empty() ? "." : folder;
    browsing.entries = roots.can_read(here) ? list_folder(here) : std::vector<FileEntry>();
    std::erase_if(browsing.entries,
                  [&](const FileEntry& entry) { return !roots.can_read(here / entry.name); });
    browsing.folder = folder;
    browsing.known = true;
  }
  return matching(browsing.entries, typed.name, browsing.all);
}

/// Another path in the field, which keeps the keyboard.
void go_to(Transient& transient, const std::string& path) {
  transient.asked_text = path;
  transient.browsing.choice = -1;
  transient.browsing.known = false;
  transient.just_opened = true;
}

std::string above(const std::string& folder) {
  if (folder.empty() || folder.ends_with("../")) return folder + "../";
  const fs::path parent = fs::path(folder).parent_path().parent_path();
  const std::string text = parent.string();
  return text.empty() || text.ends_with('/') ? text : text + "/";
}

std::string path_of(const Transient& transient, const FileEntry& entry) {
  return split_typed(transient.asked_text).folder + entry.name;
}

void open_path(const PaneContext& context, const std::string& path) {
  const std::string command = context.transient.asks_for ? context.transient.asks_for->command : "open";
  context.transient.asks_for.reset();
  context.perform(command + " " + ui::quoted(without_tilde(path, home_folder())));
}

bool asks_for_recording(const Transient& transient) {
  return transient.asks_for && !transient.asks_for->command.starts_with("choose-");
}

/// Goes into a folder, or opens what is a recording.
void choose(const PaneContext& context, const FileEntry& entry) {
  const std::string path = path_of(context.transient, entry);
  if (entry.folder && !(entry.opens && asks_for_recording(context.transient)))
    return go_to(context.transient, path + "/");
  open_path(context, path);
}

/// What was typed: a folder without a recording is gone into.
void choose_typed(const PaneContext& context) {
  const std::string& typed = context.transient.asked_text;
  if (typed.empty()) return;
  std::error_code failed;
  const std::string path = without_tilde(typed, home_folder());
  const fs::path whole = fs::path(path).lexically_normal();
  const fs::path folder = whole.has_filename() ? whole : whole.parent_path();
  const bool readable = context.explorer.files.roots().can_read(path);
  const bool recording = readable && asks_for_recording(context.transient) && opens_as_recording(folder);
  if (readable && fs::is_directory(path, failed) && !recording)
    return go_to(context.transient, typed.ends_with('/') ? typed : typed + "/");
  open_path(context, typed);
}

/// Tab completes; a path that was put into the field has the cursor at its end.
int edit_path(ImGuiInputTextCallbackData* data) {
  const PaneContext& context = *static_cast<const PaneContext*>(data->UserData);
  Transient& transient = context.transient;
  if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
    const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
    transient.asked_text = typed;
    const std::string longer = completed(typed, entries_now(transient, context.explorer.files.roots()));
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, longer.c_str());
  } else if (transient.browsing.to_end) {
    transient.browsing.to_end = false;
    data->CursorPos = data->BufTextLen;
    data->ClearSelection();
  }
  return 0;
}

bool path_field(const PaneContext& context) {
  Transient& transient = context.transient;
  if (transient.just_opened) {
    ImGui::SetKeyboardFocusHere();
    transient.browsing.to_end = true;
  }
  ImGui::SetNextItemWidth(-1e-3f);
  const std::string before = transient.asked_text;
  const bool entered = ImGui::InputTextWithHint(
      "##file", "A path; ~ is the home folder. Tab completes it.", &transient.asked_text,
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
          ImGuiInputTextFlags_CallbackAlways,
      edit_path, const_cast<PaneContext*>(&context));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  context.anchor_last("ask file");
  if (transient.asked_text != before) transient.browsing.choice = -1;
  return entered;
}

void place_button(const PaneContext& context, const std::string& title, const std::string& path) {
  if (ImGui::Selectable(fmt::format("{}##{}", printable_line(title), path).c_str()))
    go_to(context.transient, path);
  context.anchor_last("place " + path);
  tooltip(context, path.empty() ? "Where the program was started." : path);
}

/// Folders to go to, and recordings that were open before.
void recent_places(const PaneContext& context) {
  ImGui::TextDisabled("Places");
  const FileRoots& roots = context.explorer.files.roots();
  for (const fs::path& folder : roots.folders())
    place_button(context, folder.filename().empty() ? folder.string() : folder.filename().string(),
                 (folder / "").string());
  if (!roots.limited() && !home_folder().empty()) place_button(context, "Home", "~/");
  if (!roots.limited()) place_button(context, "Working folder", "");
  std::vector<std::string> folders;
  for (const std::string& path : context.transient.recent) {
    const std::string folder = fs::path(path).parent_path().string() + "/";
    if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
  }
  for (const std::string& folder : folders)
    place_button(context, fs::path(folder).parent_path().filename().string(), folder);
  if (!asks_for_recording(context.transient)) return;
  if (!context.transient.recent.empty()) ImGui::TextDisabled("Recent");
  for (const std::string& path : std::vector<std::string>(context.transient.recent)) {
    const std::string name = printable_line(fs::path(path).filename().string());
    if (ImGui::Selectable(fmt::format("{}##recent {}", name, path).c_str())) open_path(context, path);
    context.anchor_last("ask recent " + path);
    tooltip(context, path);
  }
}

void list(const PaneContext& context, const std::vector<FileEntry>& entries) {
  Transient::Browsing& browsing = context.transient.browsing;
  const float right = ImGui::GetWindowContentRegionMax().x;
  const std::string folder = split_typed(context.transient.asked_text).folder;
  if (ImGui::Selectable("..")) go_to(context.transient, above(without_tilde(folder, home_folder())));
  context.anchor_last("file ..");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const FileEntry& entry = entries[i];
    const bool chosen = static_cast<int>(i) == browsing.choice;
    const std::string name = printable_line(entry.name) + (entry.folder ? "/" : "");
    if (ImGui::Selectable(fmt::format("{}##{}", name, i).c_str(), chosen,
                          ImGuiSelectableFlags_AllowDoubleClick)) {
      browsing.choice = static_cast<int>(i);
      if (ImGui::IsMouseDoubleClicked(0) || (entry.folder && !entry.opens)) choose(context, entry);
    }
    if (chosen) ImGui::SetScrollHereY(0.5f);
    context.anchor_last("file " + entry.name);
    const std::string what = entry.folder ? (entry.opens ? "recording" : "") : size_in_words(entry.bytes);
    ImGui::SameLine(right - ImGui::CalcTextSize(what.c_str()).x - context.pxf(6));
    ImGui::TextDisabled("%s", what.c_str());
  }
  if (!entries.empty()) return;
  const FileRoots& roots = context.explorer.files.roots();
  const bool readable = roots.can_read(folder.empty() ? "." : without_tilde(folder, home_folder()));
  ImGui::TextDisabled("%s", !readable ? "This folder is outside of the folders that this program may open."
                            : browsing.all ? "Nothing here begins like that."
                                           : "Nothing here can be opened.");
}

}  // namespace

bool is_opening(const std::string& command) {
  return command == "open" || command.starts_with("choose");
}

std::string first_path(const std::vector<std::string>& recent) {
  const fs::path folder = recent.empty() ? fs::path() : fs::path(recent.front()).parent_path();
  return folder.empty() ? "" : folder.string() + "/";
}

void draw_open_dialog(const PaneContext& context, const PixelRect& whole) {
  Transient& transient = context.transient;
  const Command& command = *find_command(transient.asks_for->command);
  begin_front(context, "ask", whole, 760, 470, 0.14);
  text_in(context.fonts.heading, command.name == "open" ? "Open" : command.title);
  wrapped_text(context.style.faint_text, command.help);
  const bool entered = path_field(context);
  const std::vector<FileEntry> entries = entries_now(transient, context.explorer.files.roots());
  int& choice = transient.browsing.choice;
  const int last = static_cast<int>(entries.size()) - 1;
  if (ImGui::IsKeyPressed(keys::kDown)) ++choice;
  if (ImGui::IsKeyPressed(keys::kUp)) --choice;
  choice = std::clamp(choice, -1, last);
  const float below = ImGui::GetFrameHeightWithSpacing() + context.pxf(4);
  ImGui::BeginChild("places", {context.pxf(170), -below});
  recent_places(context);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("list", {0, -below});
  if (transient.asks_for) list(context, entries);
  ImGui::EndChild();
  ImGui::Checkbox("All files", &transient.browsing.all);
  context.anchor_last("all files");
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - context.pxf(208));
  const bool confirmed = ImGui::Button("Open", {context.pxf(100), 0}) || entered;
  context.anchor_last("button ok");
  ImGui::SameLine();
  const bool dismissed = ImGui::Button("Cancel", {context.pxf(100), 0});
  context.anchor_last("button cancel-asking");
  ImGui::End();
  if (dismissed) return context.perform("dismiss");
  if (!confirmed || !transient.asks_for) return;
  if (choice >= 0 && choice <= last)
    choose(context, entries[static_cast<std::size_t>(choice)]);
  else
    choose_typed(context);
}

}  // namespace sweepscope::ui
