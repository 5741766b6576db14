#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/printable_text.hpp"
#include "core/results/rig_parameters.hpp"
#include "render/charts/curve_charts.hpp"
#include "ui/model/explorer.hpp"

namespace sweepscope::ui {
namespace {

std::string ms(double offset_s) {
  return offset_label_ms(offset_s) + " ms";
}

std::string points_in_words(std::size_t count) {
  if (count >= 1000000) return fmt::format("{:.2f} million points", static_cast<double>(count) / 1e6);
  if (count >= 1000) return fmt::format("{} thousand points", (count + 500) / 1000);
  return fmt::format("{} points", count);
}

std::string shown(const Pane& pane) {
  if (!pane.request) return "nothing";
  const Placement& placement = pane.request->placement;
  const std::string at = ms(placement.offset_s);
  switch (pane.state) {
    case PaneState::kEmpty:
      return "nothing";
    case PaneState::kProvisional:
      return "the first second at " + at + ", not solved yet";
    case PaneState::kPreview:
      return at + ", preview along the path solved at " + ms(placement.map->offset_s);
    case PaneState::kSolved:
      return at + (pane.lost                          ? ", the motion could not be followed"
                   : !placement.loaded->poses.empty() ? ", along the given poses"
                                                      : "");
  }
  return "";
}

std::string state_word(const Pane& pane) {
  constexpr std::array<const char*, 4> kWords{"empty", "provisional", "preview", "solved"};
  return kWords[static_cast<std::size_t>(pane.state)];
}

std::string estimate_word(const Estimate* estimate) {
  if (estimate == nullptr) return "none";
  return estimate->identifiable ? "found" : "refused";
}

std::string windows_found(const Estimate* estimate) {
  if (estimate == nullptr || !estimate->over_time) return "";
  const auto& windows = estimate->over_time->windows;
  return std::to_string(
      std::ranges::count_if(windows, [](const OffsetWindow& window) { return window.offset_s.has_value(); }));
}

std::string rig_found(const Estimate* estimate) {
  if (estimate == nullptr || !estimate->rig) return "";
  std::string words;
  for (const RigParameter& parameter : rig_parameters(*estimate->rig))
    words += fmt::format("{}{} {}", words.empty() ? "" : "; ", parameter.name, in_words(parameter));
  return words;
}

std::string thickness_words(const Pane& pane) {
  if (!pane.full || !pane.thickness || !pane.request || pane.request->look.colouring != ColourBy::kBlur)
    return "";
  return in_words(*pane.thickness);
}

}  // namespace

std::string Explorer::status() const {
  if (!loaded_) return is_loading() ? "Opening a recording." : "No recording is open.";
  const Pane &a = pane(Side::kA), &b = pane(Side::kB);
  std::string text;
  switch (settings_.layout) {
    case Layout::kOnlyA:
      text = "Map A: " + shown(a);
      break;
    case Layout::kOnlyB:
      text = "Map B: " + shown(b);
      break;
    case Layout::kDifference:
      text = "Distance of each point of B (" + shown(b) + ") from its place in A (" + shown(a) + ")";
      break;
    case Layout::kSideBySide:
    case Layout::kStacked:
    case Layout::kSwipe:
      text = "A: " + shown(a) + ".  B: " + shown(b);
      break;
  }
  const PlacedCloudPtr& cloud = b.full ? b.full : b.coarse;
  if (cloud) text += ".  " + points_in_words(cloud->points->size()) + (b.full ? "" : ", thinned");
  return text + ".";
}

std::vector<std::pair<std::string, std::string>> Explorer::observables() {
  return {{"recording", "the name of the recording; empty without one"},
          {"page", "start, loading, choices or maps"},
          {"chosen-laser", "the topic on the page of choices, also where it is detected"},
          {"chosen-motor", "the joint there"},
          {"chosen-problem", "what is missing there; empty if it can be opened"},
          {"chosen-parts", "in how many parts the rig stood or moved; 0: not known yet"},
          {"kind", "stationary, moving or unknown"},
          {"state-a, state-b", "empty, provisional, preview or solved"},
          {"points-a, points-b", "how many points the pane shows"},
          {"thickness-a, thickness-b", "how thick the map's surfaces are; empty unless blur colours it"},
          {"places", "at how many places the maps differ, as far as they are listed"},
          {"place-at", "x and y of the place that the close-up shows; empty without one"},
          {"playing", "on or off"},
          {"estimate", "none, found or refused"},
          {"candidates", "how many candidates the charts show"},
          {"found-ms", "the offset found"},
          {"found-windows", "how many windows have an offset of their own; empty unless it was over time"},
          {"found-rig", "what was solved for beside the offset: \"mount pitch 3.002 ± 0.004°; ...\""},
          {"message", "the message in front; empty without one"},
          {"status", "the status line"},
          {"jobs", "how many jobs run or are queued"},
          {"(a setting)", "its value, as its command takes it: offset-a, layout, table, ..."}};
}

std::optional<std::string> Explorer::observe(std::string_view name) const {
  const auto points = [&](Side side) {
    const PlacedCloudPtr& cloud = pane(side).full ? pane(side).full : pane(side).coarse;
    return std::to_string(cloud ? cloud->points->size() : 0);
  };
  if (name == "recording") return loaded_ ? loaded_->recording.name : "";
  if (name == "kind")
    return !loaded_ || !loaded_->moving ? "unknown" : *loaded_->moving ? "moving" : "stationary";
  if (name == "state-a") return state_word(pane(Side::kA));
  if (name == "state-b") return state_word(pane(Side::kB));
  if (name == "points-a") return points(Side::kA);
  if (name == "points-b") return points(Side::kB);
  if (name == "thickness-a") return thickness_words(pane(Side::kA));
  if (name == "thickness-b") return thickness_words(pane(Side::kB));
  if (name == "places") return std::to_string(places_.size());
  if (name == "place-at") {
    const PlacePtr at = place();
    return at ? fmt::format("{:.2f} {:.2f}", at->found.region.centre_m.x(), at->found.region.centre_m.y())
              : "";
  }
  if (name == "playing") return playing_ ? "on" : "off";
  if (name == "estimate") return estimate_word(estimate());
  if (name == "candidates") return std::to_string(charted() != nullptr ? charted()->curve.size() : 0);
  if (name == "found-ms")
    return estimate_ && estimate_->offset_s ? fmt::format("{:.4f}", *estimate_->offset_s * 1e3) : "";
  if (name == "found-windows") return windows_found(estimate());
  if (name == "found-rig") return rig_found(estimate());
  if (name == "message") return message_ ? message_->text : "";
  if (name == "status") return status();
  if (name == "jobs") return std::to_string(background_.status().size());
  if (auto chosen = observe_choices(name)) return chosen;
  const Command* command = find_command(name);
  if (command == nullptr || !command->is_field()) return std::nullopt;
  std::string words;
  for (const Value& value : command->get(settings_))
    words += fmt::format("{}{}", words.empty() ? "" : " ", to_word(value));
  return words;
}

std::string Explorer::command_line(int width_px, int height_px) const {
  std::string recording, lines;
  if (loaded_ && loaded_->choices.file.empty()) {
    lines += loaded_->source + "; wait loaded; ";
  } else if (loaded_) {
    const ReadingChoices& read = loaded_->choices;
    recording = fmt::format(" {}", shell_word(read.file));
    if (!read.poses.empty()) recording += fmt::format(" --poses {}", shell_word(read.poses));
    recording += shell_options(read, true);
  }
  if (options_.assume)
    recording += options_.assume == RigKind::kMoving ? " --assume moving" : " --assume stationary";
  for (const std::string& line : lines_to_reach(settings_)) lines += line + "; ";
  // Said even where it is the default: an estimate leaves alone what a person set.
  if (estimate_) lines += fmt::format("offset-b {}; estimate; ", settings_.offset_b_ms);
  return fmt::format("sweepscope view{} --headless --size {}x{} --run {}", recording, width_px, height_px,
                     shell_word(lines + "wait solved; screenshot picture.png"));
}

}  // namespace sweepscope::ui
