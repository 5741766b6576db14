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

/// Enter on the entry that has the focus: ImGui itself does nothing with it in a menu.
bool chosen_by_key(bool makes_sense) {
  if (!makes_sense || !ImGui::IsKeyPressed(keys::kEnter, false) || !ImGui::IsItemFocused()) return false;
  ImGui::CloseCurrentPopup();
  return true;
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
    if (clicked || chosen_by_key(true)) context.perform("open " + ui::quoted(path));
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
    if (clicked || chosen_by_key(enabled)) context.perform(item.line);
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
  const double room = draw_tasks(context, place, place.right() - context.px(28) - equation_width) -
                      place.left - context.px(14);
  list.PushClipRect(corner(place), vec(place.left + context.px(14) + room, place.bottom()));
  list.AddText({context.pxf(14), y}, to_imgui(context.style.text), words.c_str());
  list.PopClipRect();
  list.AddText({static_cast<float>(place.right() - context.px(14) - equation_width), y},
               to_imgui(context.style.faint_text), equation.c_str());
  ImGui::PopFont();
  end_panel();
}

}  // namespace sweepscope::ui
