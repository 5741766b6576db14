#include <fmt/format.h>

#include <cmath>

#include "core/io/printable_text.hpp"
#include "render/charts/curve_charts.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// What the stamps' summary says, or the mean where it has none.
double rate_hz(const StreamSummary& stream) {
  if (stream.rate_hz() > 0 || stream.duration_s <= 0) return stream.rate_hz();
  return static_cast<double>(stream.used - 1) / stream.duration_s;
}

void recording_rows(const PaneContext& context, const Loaded& loaded) {
  const RecordingSummary& summary = loaded.summary;
  const LaserSummary& laser = summary.laser;
  const MotorSummary& motor = summary.motor;
  heading(context, "Recording", true);
  row(context, "file", summary.name);
  row(context, "length",
      fmt::format("{:.1f} s, the rig {}", laser.duration_s,
                  summary.motion ? "was " + *summary.motion : "may have moved"));
  row(context, "laser",
      fmt::format("{} scans of {} beams, {:.1f} Hz", laser.used, laser.max_beams, rate_hz(laser)));
  const double usable =
      laser.beams > 0 ? 100.0 * static_cast<double>(laser.usable_beams) / static_cast<double>(laser.beams)
                      : 0;
  row(context, "ranges", fmt::format("{:.0f} % usable, median {:.1f} m", usable, laser.median_range_m));
  row(context, "motor",
      fmt::format("{:.0f}° to {:.0f}°, {} whole sweeps{}", motor.min_deg, motor.max_deg, motor.whole_sweeps(),
                  motor.median_sweep_s > 0 ? fmt::format(" of {:.2f} s", motor.median_sweep_s) : ""));
  row(context, "speed",
      fmt::format("{:.0f} °/s: 1 ms is {:.2f}°", motor.median_speed_deg_s, motor.deg_per_ms()));
  const std::size_t gaps = laser.gaps + motor.gaps;
  if (gaps > 0)
    row(context, "gaps", fmt::format("{} in the scans, {} in the motor's samples", laser.gaps, motor.gaps));
  if (loaded.truth_s) row(context, "truth", offset_label_ms(*loaded.truth_s) + " ms, as simulated");
}

void notes(const PaneContext& context, const Loaded& loaded) {
  std::vector<std::string> all = loaded.summary.warnings;
  for (const Side side : kBothSides) {
    const Pane& pane = context.explorer.pane(side);
    const char* name = side == Side::kA ? "A" : "B";
    if (!pane.problem.empty()) all.push_back(fmt::format("Map {}: {}", name, pane.problem));
  }
  if (all.empty()) return;
  heading(context, "Notes");
  ImGui::PushFont(context.fonts.small);
  ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(context.style.faint_text));
  for (const std::string& note : all) ImGui::TextWrapped("%s", printable_line(note).c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void search(const PaneContext& context) {
  heading(context, "Search");
  field(context, "method");
  field(context, "search");
  if (context.settings().search == Search::kRange) field(context, "search-range");
  field(context, "fit");
  ImGui::Dummy({0, context.pxf(2)});
  if (context.explorer.background().has("estimate"))
    button(context, "Cancel", "cancel");
  else
    button(context, "Estimate the offset", "estimate", 0, context.explorer.estimate() == nullptr);
}

void criterion_rows(const PaneContext& context, const Estimate& estimate) {
  for (const CriterionOptimum& optimum : estimate.criteria) {
    const std::string at = fmt::format("{:.2f} ms", optimum.offset_s * 1e3);
    if (optimum.name == "e")
      row(context, "min e", fmt::format("{:.1f} mm at {}", optimum.value * 1e3, at));
    else if (optimum.name == "n")
      row(context, "max n", fmt::format("{:.0f} matches at {}", optimum.value, at));
    else
      row(context, optimum.name.c_str(), fmt::format("{:.4f} at {}", optimum.value, at));
  }
}

void answer(const PaneContext& context, const Estimate& estimate) {
  heading(context, "Offset found");
  if (estimate.identifiable && estimate.offset_s) {
    std::string text = fmt::format("{:.2f}", *estimate.offset_s * 1e3);
    if (estimate.sigma_s) text += fmt::format(" ± {:.2f}", *estimate.sigma_s * 1e3);
    ImGui::PushFont(context.fonts.title);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopFont();
    ImGui::SameLine(0, context.pxf(6));
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + context.pxf(10));
    ImGui::TextDisabled("ms");
    criterion_rows(context, estimate);
    row(context, "from", fmt::format("{} sweeps, {} scans", estimate.sweeps, estimate.scans));
    ImGui::Dummy({0, context.pxf(2)});
    button(context, "Use it for map B", "take-found");
  } else {
    ImGui::PushFont(context.fonts.heading);
    ImGui::TextUnformatted("Not determined");
    ImGui::PopFont();
    for (const std::string& reason : estimate.reasons)
      ImGui::TextWrapped("%s", printable_line(reason).c_str());
  }
  ImGui::PushFont(context.fonts.small);
  ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(context.style.faint_text));
  for (const std::string& warning : estimate.warnings)
    ImGui::TextWrapped("%s", printable_line(warning).c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

}  // namespace

void draw_recording_panel(const PaneContext& context, const PixelRect& place) {
  if (place.width <= 0 || context.explorer.loaded() == nullptr) return;
  begin_panel(context, "recording", place);
  recording_rows(context, *context.explorer.loaded());
  search(context);
  if (const Estimate* estimate = context.explorer.estimate()) answer(context, *estimate);
  notes(context, *context.explorer.loaded());
  end_panel();
}

}  // namespace sweepscope::ui
