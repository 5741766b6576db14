#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/model/playback.hpp"
#include "ui/panes/map_tools.hpp"
#include "ui/panes/number_box.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// A triangle or two bars.
void draw_sign(const PaneContext& context, const ImVec2& middle, bool playing) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 colour = to_imgui(context.style.text);
  const float r = context.pxf(6);
  if (!playing)
    return list.AddTriangleFilled({middle.x - 0.7f * r, middle.y - r}, {middle.x - 0.7f * r, middle.y + r},
                                  {middle.x + r, middle.y}, colour);
  for (const float way : {-1.0f, 1.0f})
    list.AddRectFilled({middle.x + way * 0.55f * r - 0.3f * r, middle.y - r},
                       {middle.x + way * 0.55f * r + 0.3f * r, middle.y + r}, colour);
}

void play_button(const PaneContext& context, const PixelRect& place) {
  if (invisible_button("play", place)) context.perform("play");
  context.anchor_last("button play");
  tooltip(context, find_command("play")->help + "  [" + chord_of("play") + "]");
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  if (ImGui::IsItemHovered())
    ImGui::GetWindowDrawList()->AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_ButtonHovered),
                                              context.pxf(3));
  draw_sign(context, {(from.x + to.x) / 2, (from.y + to.y) / 2}, context.explorer.is_playing());
}

void slider(const PaneContext& context, const PixelRect& place) {
  const double duration_s = std::max(context.explorer.loaded()->duration_s(), 1e-3);
  invisible_button("time", place);
  context.anchor_last("time");
  tooltip(context, find_command("time")->help);
  if (ImGui::IsItemActivated()) context.begin_gesture();
  if (ImGui::IsItemActive()) {
    const double share =
        std::clamp((static_cast<double>(ImGui::GetIO().MousePos.x) - place.left) / place.width, 0.0, 1.0);
    const double time_s = std::round(share * duration_s * 1e3) / 1e3;
    if (time_s != context.settings().time_s)
      context.perform(Call{find_command("time"), {time_s}}, context.transient.gesture);
  }
  const double share = std::clamp(context.settings().time_s / duration_s, 0.0, 1.0);
  const auto left = static_cast<float>(place.left), right = static_cast<float>(place.right());
  const auto y = static_cast<float>(place.top + place.height / 2), h = context.pxf(2);
  const float x = left + static_cast<float>(share) * (right - left);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({left, y - h}, {right, y + h}, to_imgui(context.style.frame), h);
  list.AddRectFilled({left, y - h}, {x, y + h}, to_imgui(colour_of_b(context.style)), h);
  list.AddCircleFilled({x, y}, context.pxf(7), to_imgui(colour_of_b(context.style)));
}

}  // namespace

void draw_playback(const PaneContext& context, const PixelRect& place) {
  if (place.height <= 0) return;
  begin_panel(context, "playback", place, false);
  const double gap = context.px(10), height = context.px(24), top = place.top + (place.height - height) / 2;
  const double left = place.left + gap;
  const std::string words =
      fmt::format("{:.2f} of {:.1f} s", context.settings().time_s, context.explorer.loaded()->duration_s());
  const double words_px = static_cast<double>(ImGui::CalcTextSize("0000.00 of 0000.0 s").x);
  const double speed_px = context.px(70), close_px = context.px(24);
  const double end = place.right() - gap - close_px - gap - speed_px - gap - words_px;
  play_button(context, {left, top, height, height});
  slider(context,
         {left + height + 2 * gap, top, std::max(end - 2 * gap - left - height - gap, 10.0), height});
  const auto y = static_cast<float>(place.top + place.height / 2) - ImGui::GetFrameHeight() / 2;
  ImGui::SetCursorScreenPos({static_cast<float>(end), y});
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", words.c_str());
  ImGui::SetCursorScreenPos({static_cast<float>(place.right() - gap - close_px - gap - speed_px), y});
  ImGui::SetNextItemWidth(static_cast<float>(speed_px));
  const Command& speed = *find_command("play-speed");
  NumberBox box = box_of(speed, 0);
  box.per_px = 0.02;
  box.format = "%.2f×";
  number_box(context, box);
  context.anchor_last("play-speed");
  tooltip(context, speed.help);
  ImGui::SetCursorScreenPos({static_cast<float>(place.right() - gap - close_px), y});
  if (ImGui::Button("×##stop", {static_cast<float>(close_px), 0})) context.perform("time -1");
  context.anchor_last("button time -1");
  end_panel();
}

void draw_played_scan(const PaneContext& context, Side side, const Projection& projection) {
  const auto& request = context.explorer.pane(side).request;
  if (!request || context.settings().time_s < 0) return;
  const PlayedScan played = played_scan(request->placement, context.settings().time_s);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool dark = ink_of(context).green > 128;
  const ImU32 colour = dark ? IM_COL32(255, 90, 160, 255) : IM_COL32(190, 0, 90, 255);
  const float half = context.pxf(1.5);
  for (const auto& p_m : played.points_m) {
    const auto at = projection({p_m[0], p_m[1], p_m[2]});
    if (!at) continue;
    const auto x = static_cast<float>(at->x), y = static_cast<float>(at->y);
    list.AddRectFilled({x - half, y - half}, {x + half, y + half}, colour);
  }
  const auto at = played.sensor_m ? projection(*played.sensor_m) : std::nullopt;
  if (!at) return;
  const ImVec2 sensor = vec(at->x, at->y);
  list.AddCircleFilled(sensor, context.pxf(5), colour);
  list.AddCircle(sensor, context.pxf(5), to_imgui(ink_of(context)), 0, context.pxf(1.5));
}

}  // namespace sweepscope::ui
