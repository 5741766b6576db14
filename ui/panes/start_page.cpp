#include <algorithm>
#include <filesystem>

#include "core/io/printable_text.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

void centred_window(const PaneContext& context, const char* name, const PixelRect& place, double width,
                    double height) {
  const double w = std::min(context.px(width), place.width - context.px(40));
  const double h = std::min(context.px(height), place.height - context.px(20));
  begin_panel(context, name,
              {std::round(place.left + (place.width - w) / 2),
               std::round(place.top + (place.height - h) / 2.4), w, h});
}

/// What the last widget does can be chosen by the keyboard too.
void can_be_chosen(const PaneContext& context, const std::string& line) {
  Transient& transient = context.transient;
  if (static_cast<int>(transient.start_lines.size()) == transient.start_choice) {
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const float gap = context.pxf(2);
    ImGui::GetWindowDrawList()->AddRect({from.x - gap, from.y - gap}, {to.x + gap, to.y + gap},
                                        to_imgui(context.style.text), context.pxf(4), 0, context.pxf(1.5f));
  }
  transient.start_lines.push_back(line);
}

/// Beside the last widget, on a narrow page below it.
void beside(const PaneContext& context, const char* text) {
  if (ImGui::GetWindowWidth() >= context.pxf(480)) {
    ImGui::SameLine(0, context.pxf(14));
    ImGui::AlignTextToFramePadding();
  }
  wrapped_text(context.style.faint_text, text);
}

void start_button(const PaneContext& context, const char* title, const char* text, const std::string& line,
                  bool primary = false) {
  ImGui::BeginGroup();
  button(context, title, line, context.px(200), primary);
  can_be_chosen(context, line);
  ImGui::EndGroup();
  beside(context, text);
}

void recent_files(const PaneContext& context) {
  heading(context, "Recent");
  if (context.transient.recent.empty()) {
    ImGui::TextDisabled("Recordings that you open are listed here.");
    return;
  }
  for (const std::string& path : context.transient.recent) {
    if (ImGui::Selectable(printable_line(std::filesystem::path(path).filename().string()).c_str()))
      context.perform("open " + ui::quoted(path));
    context.anchor_last("recent " + path);
    can_be_chosen(context, "open " + ui::quoted(path));
    tooltip(context, path);
  }
}

}  // namespace

void draw_start_page(const PaneContext& context, const PixelRect& place) {
  context.transient.start_lines.clear();
  centred_window(context, "start", place, 620, 430);
  text_in(context.fonts.title, "sweepscope");
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled(
      "Change the time offset between a laser scanner and its motor, and see the map come into focus.");
  ImGui::PopTextWrapPos();
  heading(context, "Open a recording");
  start_button(context, "Open …", "or drop one onto this window", "ask open", true);
  heading(context, "Or try a simulated one; its true offset is 24 ms");
  start_button(context, "A room", "stationary, 4.5 s", "sample room-1");
  start_button(context, "A metro station", "20 s of a walk around a pillar", "sample metro-station 20");
  recent_files(context);
  end_panel();
}

void draw_loading_page(const PaneContext& context, const PixelRect& place) {
  centred_window(context, "loading", place, 420, 150);
  for (const JobStatus& job : context.explorer.background.status()) {
    if (job.key != "load") continue;
    text_in(context.fonts.heading, job.title);
    ImGui::Dummy({0, context.pxf(4)});
    progress_bar(context, job.fraction);
    const std::string left = time_left(job.seconds_left);
    ImGui::TextDisabled("%s%s%s", job.phase.empty() ? "beginning" : job.phase.c_str(),
                        left.empty() ? "" : ", ", left.c_str());
  }
  ImGui::Dummy({0, context.pxf(4)});
  button(context, "Cancel", "cancel", context.px(110));
  end_panel();
}

}  // namespace sweepscope::ui
