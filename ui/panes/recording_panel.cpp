#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/io/printable_text.hpp"
#include "core/results/rig_parameters.hpp"
#include "render/charts/curve_charts.hpp"
#include "ui/panes/rig_recordings.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// What the stamps' summary says, or the mean where it has none.
double rate_hz(const StreamSummary& stream) {
  if (stream.rate_hz() > 0 || stream.duration_s <= 0) return stream.rate_hz();
  return static_cast<double>(stream.used - 1) / stream.duration_s;
}

/// Whether what is open is the part that the answer is of.
bool is_answered_part(const PaneContext& context) {
  const Estimate* found = context.explorer.estimating.found();
  return found != nullptr && found->stationary_part && context.explorer.loaded()->choices.window;
}

void recording_rows(const PaneContext& context, const Loaded& loaded, bool first) {
  const RecordingSummary& summary = loaded.summary;
  const LaserSummary& laser = summary.laser;
  const MotorSummary& motor = summary.motor;
  heading(context, "Recording", first);
  row(context, "file", summary.name);
  if (const auto& part = loaded.choices.window)
    row(context, "part", fmt::format("{:.1f} to {:.1f} s", part->from_s, part->to_s));
  row(context, "length",
      fmt::format("{:.1f} s, the rig {}", laser.duration_s,
                  summary.motion              ? "was " + *summary.motion
                  : is_answered_part(context) ? "was stationary"
                                              : "may have moved"));
  row(context, "laser",
      fmt::format("{} scans of {} beams, {:.1f} Hz", laser.used, laser.max_beams, rate_hz(laser)));
  const double usable =
      laser.beams > 0 ? 100.0 * static_cast<double>(laser.usable_beams) / static_cast<double>(laser.beams)
                      : 0;
  row(context, "ranges", fmt::format("{:.0f} % usable, median {:.1f} m", usable, laser.median_range_m));
  row(context, "motor",
      fmt::format("{:.0f}° to {:.0f}°, {}{}", motor.min_deg, motor.max_deg,
                  motor.one_way ? fmt::format("{:.1f} turns, all one way", motor.turns_one_way())
                                : fmt::format("{} whole sweep{}", motor.whole_sweeps(),
                                              motor.whole_sweeps() == 1 ? "" : "s"),
                  motor.median_sweep_s > 0 ? fmt::format(" of {:.2f} s", motor.median_sweep_s) : ""));
  row(context, "speed",
      fmt::format("{:.0f} °/s: 1 ms is {:.2f}°", motor.median_speed_deg_s, motor.deg_per_ms()));
  const std::size_t gaps = laser.gaps + motor.gaps;
  if (gaps > 0)
    row(context, "gaps", fmt::format("{} in the scans, {} in the motor's samples", laser.gaps, motor.gaps));
  if (loaded.truth_s) row(context, "truth", offset_label_ms(*loaded.truth_s) + " ms, as simulated");
}

/// Remarks under a title of their own, beside a line in their tone.
void remarks(const PaneContext& context, const char* title, const std::vector<std::string>& all,
             const Colour& tone) {
  if (all.empty()) return;
  ImGui::Dummy({0, context.pxf(3)});
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Indent(context.pxf(12));
  ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(tone));
  text_in(context.fonts.bold, all.size() == 1 ? std::string(title).substr(0, std::strlen(title) - 1) : title);
  ImGui::PopStyleColor();
  ImGui::PushFont(context.fonts.small);
  for (const std::string& remark : all) wrapped_text(context.style.text, sentence(remark));
  ImGui::PopFont();
  ImGui::Unindent(context.pxf(12));
  const float to = ImGui::GetCursorScreenPos().y - ImGui::GetStyle().ItemSpacing.y;
  ImGui::GetWindowDrawList()->AddRectFilled(from, {from.x + context.pxf(3), to}, to_imgui(tone));
}

std::vector<std::string> notes_of(const Explorer& explorer) {
  std::vector<std::string> all = explorer.loaded()->summary.warnings;
  for (const Side side : kBothSides) {
    const Pane& pane = explorer.pane(side);
    const char* name = side == Side::kA ? "A" : "B";
    if (!pane.problem.empty()) all.push_back(fmt::format("Map {}: {}", name, pane.problem));
  }
  for (const Side side : kBothSides) {  // mostly they have one path
    const std::string& warning = explorer.pane(side).warning;
    if (!warning.empty() && std::ranges::find(all, warning) == all.end()) all.push_back(warning);
  }
  return all;
}

/// What helps, of the estimate and of the notes. The buttons come before the remarks, which may be longer
/// than the window is high.
void what_helps(const PaneContext& context, const Estimate* estimate, const std::vector<std::string>& notes) {
  std::vector<Hint> hints;
  if (estimate != nullptr) hints = hints_for(context.explorer, *estimate);
  for (Hint& hint : hints_for(context.explorer, notes))
    if (std::ranges::find(hints, hint.line, &Hint::line) == hints.end()) hints.push_back(std::move(hint));
  if (hints.empty()) return;
  ImGui::Dummy({0, context.pxf(2)});
  hint_buttons(context, hints);
}

/// Whether an estimate is one of the paper's: only these are fitted, and only the direct method solves for
/// more than the offset.
bool is_of_the_paper(const Settings& settings) {
  const bool direct = settings.method == "automatic" || settings.method == "direct";
  return !direct || settings.search == Search::kRange || settings.fit != "automatic";
}

void search(const PaneContext& context) {
  const Settings& settings = context.settings();
  heading(context, "Estimate");
  field(context, "method");
  field(context, "search");
  if (settings.search == Search::kRange) field(context, "search-range");
  if (settings.search == Search::kOverTime) field(context, "search-window");
  field(context, is_of_the_paper(settings) ? "fit" : "solve-for");
  const auto solves_for = [&](const char* part) {
    return !is_of_the_paper(settings) && settings.solve_for.find(part) != std::string::npos;
  };
  if (solves_for("mount")) field(context, "mount-prior");
  if (solves_for("play") || solves_for("encoder")) field(context, "gear-prior");
  ImGui::Dummy({0, context.pxf(2)});
  if (context.explorer.estimating.is_running())
    button(context, "Cancel", "cancel");
  else
    button(context, "Estimate the offset", "estimate", 0, context.explorer.estimating.found() == nullptr);
}

/// An optimum in plain words: what it is the least or the most of, its value with its unit, and what that
/// means.
struct OptimumWords {
  const char* name;
  std::string value;
  const char* meaning;
};

OptimumWords in_words(const CriterionOptimum& optimum) {
  const double mm = optimum.value * 1e3;
  if (optimum.name == "e")
    return {"distance", fmt::format("{:.1f} mm", mm),
            "Criterion e, equation 7: the mean distance of the matches from their line or plane on the map, "
            "at its minimum."};
  if (optimum.name == "n")
    return {
        "matches", fmt::format("{:.0f}", optimum.value),
        "Criterion n, equation 6: the number of edge and plane points that match the map, at its maximum."};
  if (optimum.name == "d")
    return {"motion", fmt::format("{:.4f} m", optimum.value),
            "Criterion d, equation 3: the motion that odometry finds between sweeps of a stationary rig, at "
            "its minimum. A rotation counts as a translation: 1 rad as 1 m, times weight c."};
  if (optimum.name == "capped_cost")
    return {"distance", fmt::format("{:.1f} mm", mm),
            "The mean distance between sweeps of opposite directions, each distance capped, at its minimum."};
  if (optimum.name == "direct")
    return {"residual", fmt::format("{:.1f} mm", mm),
            "The remaining distance of the points from the surfaces of the sweeps that they are compared "
            "with, at the offset. With a good offset it is about the noise of the ranges."};
  return {optimum.name.c_str(), fmt::format("{:.4g}", optimum.value), "The criterion's extremum."};
}

void criterion_rows(const PaneContext& context, const Estimate& estimate) {
  for (const CriterionOptimum& optimum : estimate.criteria) {
    const OptimumWords words = in_words(optimum);
    row(context, words.name, fmt::format("{} at {:.2f} ms", words.value, optimum.offset_s * 1e3));
    context.anchor_last("answer " + optimum.name);
    tooltip(context, words.meaning);
  }
}

/// What the number and its uncertainty mean.
std::string meaning_of(const Estimate& estimate) {
  std::string words =
      fmt::format("The motor's clock shows {:.2f} ms more than the laser's: t_motor = t_laser + offset.",
                  *estimate.offset_s * 1e3);
  if (!estimate.sigma_s)
    return words + " The paper's criteria have no uncertainty; the direct method has one.";
  const double sigma_ms = *estimate.sigma_s * 1e3;
  return words +
         fmt::format(
             " ± {:.2f} ms is one standard deviation (1 sigma): the true offset lies within it in 68 of "
             "100 recordings like this one, and within {:.2f} ms in 95.",
             sigma_ms, 2 * sigma_ms);
}

/// The windows of an estimate over time, and the course through them.
void course_rows(const PaneContext& context, const OffsetOverTime& over_time) {
  const auto found = std::ranges::count_if(
      over_time.windows, [](const OffsetWindow& window) { return window.offset_s.has_value(); });
  row(context, "windows", fmt::format("{} of {} have an offset", found, over_time.windows.size()));
  if (!over_time.course) return;
  const OffsetCourse& course = *over_time.course;
  row(context, "course", course.constant() ? "constant" : "changes; the offset is given for the middle");
  if (course.rate_sigma > 0)
    row(context, "drift", fmt::format("{:.2f} ± {:.2f} ppm", course.rate * 1e6, course.rate_sigma * 1e6));
  for (const OffsetJump& jump : course.jumps)
    row(context, "jump",
        fmt::format("{:+.2f} ± {:.2f} ms near {:.0f} s", jump.size_s * 1e3, jump.sigma_s * 1e3,
                    (jump.begin_s + jump.end_s) / 2));
}

/// "pitch" of "mount pitch", in a row that names the mount once.
std::string name_within(const RigParameter& parameter) {
  const bool has_part = parameter.name.starts_with(parameter.part + " ");
  return has_part ? parameter.name.substr(parameter.part.size() + 1) + " " : "";
}

std::string meaning_of(const RigParameter& parameter) {
  const std::string unit = parameter.unit == "deg" ? "°" : " " + parameter.unit;
  const std::string by_file = fmt::format("Rig file: {:.4g}{}.", parameter.given + 0.0, unit);
  switch (parameter.state) {
    case RigParameter::State::kGauge:
      return by_file + " Kept: it only turns or shifts the whole map.";
    case RigParameter::State::kNotDetermined:
      return by_file + " The recording does not determine it.";
    case RigParameter::State::kFound:
      break;
  }
  return by_file + (parameter.sigma ? " ± is one standard deviation (1 sigma)." : "");
}

/// Whether the rig that was found is the recording's own, as it is once its rig file was opened.
bool is_drawn_with(const SolvedRig& solved, const Rig& rig) {
  constexpr double kRounded = 1e-4;  // files hold fewer digits; m and deg
  const Mount &found = solved.rig.mount, &used = rig.mount;
  return (found.laser_in_motor_rpy_deg - used.laser_in_motor_rpy_deg).norm() < kRounded &&
         (found.laser_in_motor_xyz_m - used.laser_in_motor_xyz_m).norm() < kRounded &&
         std::abs(solved.rig.gear.play_deg - rig.gear.play_deg) < kRounded &&
         std::abs(solved.rig.gear.encoder_amplitude_deg - rig.gear.encoder_amplitude_deg) < kRounded;
}

/// What was solved for beside the offset.
void rig_rows(const PaneContext& context, const SolvedRig& solved) {
  std::string part;
  for (const RigParameter& parameter : rig_parameters(solved)) {
    const std::string shown = parameter.part == "play" ? "gear play" : parameter.part;
    row(context, shown == part ? "" : shown.c_str(), name_within(parameter) + in_words(parameter));
    context.anchor_last("found " + parameter.name);
    tooltip(context, meaning_of(parameter));
    part = shown;
  }
  row(context, solved.along_walk ? "matches" : "surfaces",
      fmt::format("{:.1f} mm {}, {:.1f} mm with the rig as given", solved.residual_after_m * 1e3,
                  solved.along_walk ? "apart" : "thick", solved.residual_before_m * 1e3));
  const bool drawn = is_drawn_with(solved, context.explorer.loaded()->recording.rig);
  small_print(context,
              drawn ? "The maps are drawn with this rig." : "The maps are drawn with the rig as given.");
  if (!drawn) button(context, "Use the rig found …", "ask use-rig");
  button(context, "Export the rig found …", "ask export-rig");
}

/// How thick walls are. While opening measures them, there is room for the sentence to come.
void walls(const PaneContext& context) {
  const std::string words = context.explorer.walls_in_words();
  if (words.empty() && !context.explorer.is_answering()) return;
  if (words.empty()) {
    waiting_text("Measuring the walls …");
  } else {
    wrapped_text(words);
    context.anchor_last("walls");
  }
  ImGui::Dummy({0, context.pxf(2)});
}

void answer(const PaneContext& context, const Estimate& estimate, bool first) {
  const bool rig_first =
      estimate.rig && !estimate.offset_s;  // of a motor that turns one way: what was asked for
  if (rig_first) {
    heading(context, "Rig found", first);
    rig_rows(context, *estimate.rig);
  }
  const bool found = estimate.identifiable && estimate.offset_s;
  heading(context, found ? "Offset found" : "Offset", first && !rig_first);
  if (found) {
    std::string text = fmt::format("{:.2f}", *estimate.offset_s * 1e3);
    if (estimate.sigma_s) text += fmt::format(" ± {:.2f}", *estimate.sigma_s * 1e3);
    text_in(context.fonts.title, text);
    context.anchor_last("answer");
    tooltip(context, meaning_of(estimate));
    ImGui::SameLine(0, context.pxf(6));
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + context.pxf(10));
    ImGui::TextDisabled("ms");
    walls(context);
    criterion_rows(context, estimate);
    if (estimate.over_time) course_rows(context, *estimate.over_time);
    if (estimate.rig) rig_rows(context, *estimate.rig);
    row(context, "from", fmt::format("{} sweeps, {} scans", estimate.sweeps, estimate.scans));
    ImGui::Dummy({0, context.pxf(2)});
    button(context, "Show in map B", "take-found");
  } else {
    text_in(context.fonts.heading, "Not determined");
    for (const std::string& reason : estimate.reasons()) wrapped_text(sentence(reason));
  }
}

/// The answer, what helps where something is wrong, and why.
void answer_and_remarks(const PaneContext& context, bool first) {
  const Estimate* estimate = context.explorer.estimating.found();
  const std::vector<std::string> notes = notes_of(context.explorer);
  if (estimate != nullptr) answer(context, *estimate, first);
  what_helps(context, estimate, notes);
  if (estimate != nullptr) remarks(context, "Warnings", estimate->warnings, colour_of_a(context.style));
  remarks(context, "Notes", notes, context.style.faint_text);
  if (estimate != nullptr) ImGui::Dummy({0, context.pxf(2)});  // below the last line
}

}  // namespace

void draw_recording_panel(const PaneContext& context, const PixelRect& place, bool above) {
  if (place.width <= 0 || context.explorer.loaded() == nullptr) return;
  // Lines are as long with a scroll bar as without: otherwise what fits only without one may show either.
  ImGui::SetNextWindowContentSize({static_cast<float>(place.width) - 2 * context.pxf(kPanelMargin), 0});
  begin_panel(context, above ? "recording above" : "recording", place, true, above);
  const ImVec2 from = ImGui::GetWindowDrawList()->GetClipRectMin(),
               to = ImGui::GetWindowDrawList()->GetClipRectMax();
  ImGui::PushClipRect(from, {far_corner(place).x, to.y}, false);
  // What was opened for the answer begins with it.
  if (above) answer_and_remarks(context, true);
  if (above) search(context);
  recording_rows(context, *context.explorer.loaded(), !above);
  draw_rig_recordings(context);
  if (!above) search(context);
  if (!above) answer_and_remarks(context, false);
  ImGui::PopClipRect();
  end_panel();
}

}  // namespace sweepscope::ui
