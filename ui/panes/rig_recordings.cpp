#include "ui/panes/rig_recordings.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/io/printable_text.hpp"
#include "core/offset/estimate.hpp"
#include "ui/commands/commands.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

// What a recording says in the answer of all; null where the list has changed since. Names alone may be those
// of several folders.
const RecordingOfRig* part_of(const Estimate* found, std::size_t number, const std::string& name) {
  if (found == nullptr || !found->together || number > found->together->recordings.size()) return nullptr;
  const RecordingOfRig& part = found->together->recordings[number - 1];
  return part.recording == name ? &part : nullptr;
}

std::string in_words(const RecordingOfRig& recording, bool with_share) {
  if (!recording.offset_s) return recording.reasons.empty() ? "" : sentence(recording.reasons.front());
  std::string words =
      fmt::format("{:.2f} ± {:.2f} ms", *recording.offset_s * 1e3, recording.sigma_s.value_or(0) * 1e3);
  if (with_share) words += fmt::format(", {:.0f} % of the answer", recording.share * 100);
  return words;
}

void recording_row(const PaneContext& context, std::size_t number, const std::string& file,
                   const Estimate* found) {
  const std::string name = std::filesystem::path(file).filename().string();
  const bool open = context.explorer.loaded()->choices.file == file;
  const std::string leave_out = fmt::format("leave-out {}", number);
  const float button_px = ImGui::CalcTextSize("Leave out").x + context.pxf(16);
  const float name_px = ImGui::GetContentRegionAvail().x - button_px - ImGui::GetStyle().ItemSpacing.x;
  ImGui::PushID(static_cast<int>(number));
  ImGui::PushStyleVar(ImGuiStyleVar_SelectableTextAlign, ImVec2(0, 0.5F));
  if (ImGui::Selectable(printable_line(name).c_str(), open, 0, {name_px, ImGui::GetFrameHeight()}))
    if (!open) context.perform("open " + quoted(file));
  context.anchor_last("recording " + std::to_string(number));
  tooltip(context, open ? "It is open: " + file : "Opens " + file);
  if (!open) {
    ImGui::SameLine();
    button(context, "Leave out", leave_out, button_px);
  }
  ImGui::PopStyleVar();
  ImGui::PopID();
  if (const RecordingOfRig* part = part_of(found, number, name))
    small_print(context, in_words(*part, found->identifiable && !found->together->own_offsets));
}

}  // namespace

void draw_rig_recordings(const PaneContext& context) {
  const RigRecordings& rig = context.explorer.rig;
  if (rig.files().empty()) return;
  const Estimate* found = context.explorer.estimating.found();
  const bool answered = found != nullptr && found->together;
  heading(context, "Recordings of this rig");
  for (std::size_t i = 0; i < rig.files().size(); ++i) recording_row(context, i + 1, rig.files()[i], found);
  if (answered && found->together->degrees_of_freedom > 0)
    row(context, "agreement",
        fmt::format("chi-square {:.1f} for {} degrees of freedom", found->together->chi_square,
                    found->together->degrees_of_freedom));
  ImGui::Dummy({0, context.pxf(2)});
  if (rig.is_running())
    button(context, "Cancel", "cancel");
  else
    button(context, "Estimate from all of them", "estimate-together", 0, !answered);
  button(context, "Add a recording of this rig …", "ask add-recording");
}

}  // namespace sweepscope::ui
