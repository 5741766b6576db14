#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/io/printable_text.hpp"
#include "render/charts/curve_charts.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/host/input.hpp"
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
  const Estimate* found = explorer.estimating.found();
  if (line == "ask export-report") return explorer.loaded() != nullptr && !explorer.exports.is_running();
  if (line == "ask add-recording")
    return explorer.loaded() != nullptr && !explorer.loaded()->choices.file.empty();
  if (line == "undo") return explorer.history().can_undo();
  if (line == "redo") return explorer.history().can_redo();
  if (line == "take-found") return found != nullptr && found->offset_s;
  if (line == "ask export-rig" || line == "ask use-rig") return found != nullptr && found->rig;
  if (line == "ask export-curve") return found != nullptr;
  if (explorer.loaded() != nullptr) return true;
  return std::any_of(kAlways.begin(), kAlways.end(),
                     [&](const std::string& always) { return line.starts_with(always); });
}

/// Left and right go from an open menu to its neighbours.
void open_neighbour(const PaneContext& context, const std::string& name) {
  const int way = int(ImGui::IsKeyPressed(keys::kRight)) - int(ImGui::IsKeyPressed(keys::kLeft));
  if (way == 0) return;
  const std::vector<std::string> names = menu_names();
  const auto at = static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  const auto count = static_cast<int>(names.size());
  context.transient.opens_menu = names[static_cast<std::size_t>((at + way + count) % count)];
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

/// Recordings that were open before, each with its folder.
void recent_items(const PaneContext& context) {
  const std::vector<std::string> recent = context.transient.recent;
  if (recent.empty()) return;
  ImGui::Separator();
  for (const std::string& path : recent) {
    const std::filesystem::path file(path);
    const std::string title = printable_line(file.filename().string()),
                      folder = fit_text(printable_line(file.parent_path().string()), context.px(13),
                                        context.px(320));
    const bool clicked = ImGui::MenuItem(fmt::format("{}##{}", title, path).c_str(), folder.c_str());
    if (clicked) context.perform("open " + ui::quoted(path));
    context.anchor_last("menu recent " + path);
    tooltip(context, path);
  }
  ImGui::Separator();
}

void menu(const PaneContext& context, const std::string& name) {
  if (!ImGui::BeginMenu(name.c_str())) {
    context.anchor_last("menu " + name);
    return;
  }
  open_neighbour(context, name);
  for (const MenuItem& item : menu_items()) {
    if (item.menu != name) continue;
    if (item.line.empty()) {
      ImGui::Separator();
      continue;
    }
    const std::string chord = chord_of(item.line);
    const bool enabled = makes_sense(context.explorer, item.line);
    const bool clicked =
        ImGui::MenuItem(item.title.c_str(), chord.c_str(), holds(context.settings(), item.line), enabled);
    if (clicked) context.perform(item.line);
    context.anchor_last("menu " + item.line);
    if (item.line == "ask open") recent_items(context);
  }
  ImGui::EndMenu();
}

/// The recording's name, in the middle of the bar, or as near to it as the menus let it.
void title(const PaneContext& context, const PixelRect& place) {
  const Loaded* loaded = context.explorer.loaded();
  const double after_menus = static_cast<double>(ImGui::GetCursorScreenPos().x) + context.px(12);
  const double room = place.right() - context.px(12) - after_menus;
  const std::string text = fit_text(loaded != nullptr ? printable_line(loaded->recording.name) : "sweepscope",
                                    static_cast<double>(ImGui::GetFontSize()), std::max(room, 0.0));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const double middle = place.left + (place.width - static_cast<double>(size.x)) / 2;
  ImGui::GetWindowDrawList()->AddText(
      vec(std::max(middle, after_menus), place.top + (place.height - static_cast<double>(size.y)) / 2),
      to_imgui(context.style.faint_text), text.c_str());
}

}  // namespace

void draw_menu_bar(const PaneContext& context, const PixelRect& place) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(context.pxf(8), context.pxf(7)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(context.pxf(8), context.pxf(6)));
  if (ImGui::BeginMainMenuBar()) {
    // Asked for in the frame before: its neighbour, which was open, is drawn first.
    const std::string opened = std::exchange(context.transient.opens_menu, {});
    for (const std::string& name : menu_names()) {
      if (equal_ignoring_case(name, opened)) ImGui::OpenPopup(name.c_str());
      menu(context, name);
    }
    title(context, place);
    const float y = static_cast<float>(place.bottom()) - 1;
    ImGui::GetWindowDrawList()->AddLine({0, y}, {static_cast<float>(place.right()), y},
                                        to_imgui(context.style.frame));
    ImGui::EndMainMenuBar();
  }
  ImGui::PopStyleVar(2);
}

namespace {

/// A task in a few words, with its bar and the time left, so that it ends at `right`. Returns where it
/// begins.
double draw_task(const PaneContext& context, const JobStatus& job, const PixelRect& place, double right) {
  std::string title = job.title;
  if (job.key.starts_with("solve "))
    title += " at " + offset_label_ms(std::stod(job.key.substr(6)) * 1e-9) + " ms";
  const std::string left = !job.running ? "waits" : time_left(job.seconds_left);
  const auto width_of = [](const std::string& text) {
    return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x);
  };
  const double bar = context.px(90), gap = context.px(8);
  // The widest time that comes, or the bar would jump as the time shrinks.
  const double left_width = std::max(width_of("0:00 left"), width_of(left));
  const double begin = right - left_width - gap - bar - gap - width_of(title);
  const double middle = place.top + place.height / 2;
  const auto y = static_cast<float>(middle - static_cast<double>(ImGui::GetFontSize()) / 2);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText({static_cast<float>(begin), y}, to_imgui(context.style.text), title.c_str());
  list.AddText({static_cast<float>(right - left_width), y}, to_imgui(context.style.faint_text), left.c_str());
  const double bar_left = right - left_width - gap - bar;
  ImGui::SetCursorScreenPos(vec(bar_left, middle - context.px(2.5)));
  progress_bar(context, job.running ? job.fraction : 0, bar);
  invisible_button("task " + job.key, {begin, place.top, right - begin, place.height});
  context.anchor_last("task " + job.key.substr(0, job.key.find(' ')));
  tooltip(context, fmt::format("{}: {:.0f} %{}", title, std::floor(100 * job.fraction),
                               job.phase.empty() ? "" : ", " + job.phase));
  return begin;
}

/// One bar for each task, from the right: those that run first. Returns where they begin.
double draw_tasks(const PaneContext& context, const PixelRect& place, double right) {
  std::vector<JobStatus> jobs = context.explorer.background.status();
  const bool on_page = context.explorer.loaded() == nullptr;  // the page that waits for it has its bar
  std::erase_if(jobs, [&](const JobStatus& job) {
    return job.key.starts_with("place") || (on_page && job.key == "load");  // "refining" stands for the first
  });
  std::stable_partition(jobs.begin(), jobs.end(), [](const JobStatus& job) { return job.running; });
  for (const JobStatus& job : jobs) {
    if (right < place.left + 0.4 * place.width) break;  // the rest comes when these are done
    right = draw_task(context, job, place, right) - context.px(24);
  }
  return right;
}

}  // namespace

void draw_status_bar(const PaneContext& context, const PixelRect& place) {
  begin_panel(context, "status", place, false);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddLine(corner(place), vec(place.right(), place.top), to_imgui(context.style.frame));
  ImGui::PushFont(context.fonts.small);
  const std::string equation = "t_motor = t_laser + offset";
  const double equation_width = static_cast<double>(ImGui::CalcTextSize(equation.c_str()).x);
  const auto y =
      static_cast<float>(place.top + (place.height - static_cast<double>(ImGui::GetFontSize())) / 2);
  const std::string words = status(context.explorer);
  const double words_width = static_cast<double>(ImGui::CalcTextSize(words.c_str()).x);
  const bool with_equation = words_width + equation_width + context.px(56) < place.width;
  const double room =
      draw_tasks(context, place,
                 place.right() - context.px(14) - (with_equation ? equation_width + context.px(14) : 0)) -
      place.left - context.px(14);
  const std::string fitting =
      words_width <= room ? words : fit_text(words, static_cast<double>(ImGui::GetFontSize()), room);
  list.PushClipRect(corner(place), vec(place.left + context.px(14) + room, place.bottom()));
  list.AddText({context.pxf(14), y}, to_imgui(context.style.text), fitting.c_str());
  list.PopClipRect();
  if (with_equation)
    list.AddText({static_cast<float>(place.right() - context.px(14) - equation_width), y},
                 to_imgui(context.style.faint_text), equation.c_str());
  ImGui::PopFont();
  end_panel();
}

namespace {

/// The estimate in a few words: what to press for it, how far it is, or its answer.
std::string offset_in_words(const Explorer& explorer) {
  const Estimate* found = explorer.estimating.found();
  if (found == nullptr) return "Estimate";
  if (!found->identifiable || !found->offset_s) return "Not determined";
  return fmt::format("{:.2f}{} ms", *found->offset_s * 1e3,
                     found->sigma_s ? fmt::format(" ± {:.2f}", *found->sigma_s * 1e3) : "");
}

struct Tab {
  std::string title, line;
  bool primary = false, open = false;
};

void draw_tab(const PaneContext& context, const Tab& tab, const PixelRect& place) {
  ImGui::SetCursorScreenPos(corner(place));
  if (tab.open) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      vec(context.px(4), (place.height - static_cast<double>(ImGui::GetFontSize())) / 2));
  const std::string title =
      fit_text(tab.title, static_cast<double>(ImGui::GetFontSize()), place.width - context.px(8));
  button(context, title.c_str(), tab.line, place.width, tab.primary);
  ImGui::PopStyleVar();
  if (tab.open) ImGui::PopStyleColor();
}

}  // namespace

void draw_tabs(const PaneContext& context, const PixelRect& place) {
  if (place.height <= 0) return;
  const Explorer& explorer = context.explorer;
  const Sheet sheet = context.settings().sheet;
  const auto panel = [&](std::string title, Sheet which, const std::string& name) {
    const bool open = sheet == which;
    return Tab{std::move(title), "open-panel " + (open ? "none" : name), false, open};
  };
  const bool estimated = explorer.estimating.found() != nullptr;
  Tab first = estimated ? panel(offset_in_words(explorer), Sheet::kRecording, "recording")
                        : Tab{"Estimate", "estimate", true};
  if (explorer.estimating.is_running()) first = {"Cancel the estimate", "cancel"};
  std::vector<Tab> tabs{first};
  if (!estimated || explorer.estimating.is_running())
    tabs.push_back(panel("Recording", Sheet::kRecording, "recording"));
  tabs.push_back(panel("Display", Sheet::kDisplay, "display"));
  tabs.push_back({"More …", "palette"});
  begin_panel(context, "tabs", place, false);
  ImGui::GetWindowDrawList()->AddLine(corner(place), vec(place.right(), place.top),
                                      to_imgui(context.style.frame));
  // Each as wide as its words, and all share what is left of the width.
  const auto width_of = [](const Tab& tab) {
    return static_cast<double>(ImGui::CalcTextSize(tab.title.c_str()).x);
  };
  const double gap = context.px(6), count = static_cast<double>(tabs.size());
  double spare = place.width - gap * (count + 1);
  for (const Tab& tab : tabs) spare -= width_of(tab);
  double left = place.left + gap;
  for (const Tab& tab : tabs) {
    const double width = width_of(tab) + spare / count;
    draw_tab(context, tab, {left, place.top + gap, width, place.height - 2 * gap});
    left += width + gap;
  }
  end_panel();
}

}  // namespace sweepscope::ui
