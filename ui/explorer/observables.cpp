#include "ui/explorer/observables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/printable_text.hpp"
#include "core/results/rig_parameters.hpp"
#include "render/charts/curve_charts.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/model/picking.hpp"

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
      return "the beginning at " + at + ", not solved yet";
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
  const bool agrees = !pane.consistency || pane.consistency->agrees_with_itself();
  return in_words(*pane.thickness) + (agrees ? "" : "; the map does not agree with itself");
}

std::string consistency_words(const Pane& pane) {
  return pane.consistency ? in_words(*pane.consistency) : "";
}

std::string path_of(const Pane& pane) {
  if (!pane.request || pane.request->placement.map->provisional) return "";
  return fmt::format("{:.10g}", pane.request->placement.map->offset_s * 1e3);
}

std::string points_of(const Pane& pane) {
  return std::to_string(pane.best() ? pane.best()->points->size() : 0);
}

std::string page_of(const Explorer& explorer) {
  if (explorer.page.choosing() != nullptr) return "choices";
  if (explorer.loaded() != nullptr) return "maps";
  return explorer.recording.is_opening() ? "loading" : "start";
}

RecordingSurvey streams_of(const Explorer& explorer) {
  const auto* choosing = explorer.page.choosing();
  return choosing != nullptr && choosing->survey ? choosing->survey->streams : RecordingSurvey();
}

std::string chosen_problem(const Explorer& explorer) {
  std::string words;
  if (explorer.page.choosing() == nullptr) return words;
  for (const std::string& sentence : problems_of(*explorer.page.choosing()))
    words += (words.empty() ? "" : "\n") + sentence;
  return words;
}

std::string place_at(const Explorer& explorer) {
  const PlacePtr at = explorer.place();
  return at ? fmt::format("{:.2f} {:.2f}", at->found.region.centre_m.x(), at->found.region.centre_m.y()) : "";
}

/// Something of the state: of the explorer, or of each of its panes, which "-a" and "-b" tell apart.
struct Observable {
  const char *name, *meaning;
  std::string (*of)(const Explorer&) = nullptr;
  std::string (*of_pane)(const Pane&) = nullptr;
};

const std::vector<Observable> kObservables{
    {"recording", "the name of the recording; empty without one",
     [](const Explorer& e) { return e.loaded() ? e.loaded()->recording.name : std::string(); }},
    {"page", "start, loading, choices or maps", page_of},
    {"chosen-laser", "the topic on the page of choices, also where it is detected",
     [](const Explorer& e) {
       const RecordingSurvey streams = streams_of(e);
       return streams.laser ? streams.lasers[*streams.laser].topic : std::string();
     }},
    {"chosen-motor", "the joint there",
     [](const Explorer& e) {
       const RecordingSurvey streams = streams_of(e);
       return streams.joint ? streams.joints[*streams.joint].joint : std::string();
     }},
    {"chosen-problem", "what is missing there; empty if it can be opened", chosen_problem},
    {"chosen-reading", "how its beams are timed, as in JSON (readings); empty: not decided",
     [](const Explorer& e) -> std::string {
       const auto* choosing = e.page.choosing();
       const auto* chosen = choosing && choosing->survey ? chosen_of(choosing->survey->readings) : nullptr;
       return chosen ? entry_of(chosen->kind).name : "";
     }},
    {"chosen-parts", "in how many parts the rig stood or moved; 0: not known yet",
     [](const Explorer& e) {
       const auto* choosing = e.page.choosing();
       return std::to_string(choosing && choosing->survey ? choosing->survey->motion.size() : 0);
     }},
    {"kind", "stationary, moving or unknown",
     [](const Explorer& e) -> std::string {
       if (!e.loaded() || !e.loaded()->moving) return "unknown";
       return *e.loaded()->moving ? "moving" : "stationary";
     }},
    {"state", "empty, provisional, preview or solved", nullptr, state_word},
    {"path", "the offset in ms that the path of its points was solved for; empty: not solved yet", nullptr,
     path_of},
    {"colours", "the values at the ends of the colour range",
     [](const Explorer& e) {
       const ColourSpan span = e.maps.shown_span();
       return fmt::format("{:.4g} {:.4g}", span.from, span.to);
     }},
    {"points", "how many points the pane shows", nullptr, points_of},
    {"thickness", "how thick the map's surfaces are; empty unless blur colours it", nullptr, thickness_words},
    {"consistency", "how far apart surfaces lie that were seen twice; empty of a stationary rig", nullptr,
     consistency_words},
    {"warning", "what is wrong with the map's path; else empty", nullptr,
     [](const Pane& pane) { return pane.warning; }},
    {"places", "at how many places the maps differ, as far as they are listed",
     [](const Explorer& e) { return std::to_string(e.places.all().size()); }},
    {"place-at", "x and y of the place that the close-up shows; empty without one", place_at},
    {"playing", "on or off", [](const Explorer& e) { return std::string(e.is_playing() ? "on" : "off"); }},
    {"estimate", "none, found or refused",
     [](const Explorer& e) { return estimate_word(e.estimating.found()); }},
    {"candidates", "how many candidates the charts show",
     [](const Explorer& e) {
       return std::to_string(e.estimating.charted() ? e.estimating.charted()->curve.size() : 0);
     }},
    {"found-ms", "the offset found",
     [](const Explorer& e) {
       const Estimate* found = e.estimating.found();
       return found && found->offset_s ? fmt::format("{:.4f}", *found->offset_s * 1e3) : std::string();
     }},
    {"walls", "how thick walls are as recorded and at the offset found; empty until both are measured",
     [](const Explorer& e) { return e.walls_in_words(); }},
    {"found-windows", "how many windows have an offset of their own; empty unless it was over time",
     [](const Explorer& e) { return windows_found(e.estimating.found()); }},
    {"found-rig", "what was solved for beside the offset: \"mount pitch 3.002 ± 0.004°; ...\"",
     [](const Explorer& e) { return rig_found(e.estimating.found()); }},
    {"message", "the message in front; empty without one",
     [](const Explorer& e) { return e.messages.shown() ? e.messages.shown()->text : std::string(); }},
    {"status", "the status line", status},
    {"jobs", "how many jobs run or are queued",
     [](const Explorer& e) { return std::to_string(e.background.status().size()); }}};

}  // namespace

std::string status(const Explorer& explorer) {
  if (explorer.loaded() == nullptr)
    return explorer.recording.is_opening() ? "Opening a recording." : "No recording is open.";
  const Pane &a = explorer.pane(Side::kA), &b = explorer.pane(Side::kB);
  std::string text;
  switch (explorer.settings().layout) {
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
  if (b.best()) text += ".  " + points_in_words(b.best()->points->size()) + (b.full ? "" : ", thinned");
  return text + ".";
}

std::vector<std::pair<std::string, std::string>> observables() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& [name, meaning, of, of_pane] : kObservables)
    all.emplace_back(of_pane != nullptr ? fmt::format("{0}-a, {0}-b", name) : name, meaning);
  all.emplace_back("(a setting)", "its value, as its command takes it: offset-a, layout, table, ...");
  return all;
}

std::optional<std::string> observe(const Explorer& explorer, std::string_view name) {
  for (const Observable& observable : kObservables) {
    if (observable.of != nullptr && name == observable.name) return observable.of(explorer);
    if (observable.of_pane == nullptr) continue;
    for (const Side side : kBothSides)
      if (name == observable.name + std::string(side == Side::kA ? "-a" : "-b"))
        return observable.of_pane(explorer.pane(side));
  }
  const Command* command = find_in(setting_commands(), name);
  if (command == nullptr || !command->is_field()) return std::nullopt;
  std::string words;
  for (const Value& value : command->get(explorer.settings()))
    words += fmt::format("{}{}", words.empty() ? "" : " ", to_word(value));
  return words;
}

Session session_of(const Explorer& explorer) {
  const Loaded* loaded = explorer.loaded();
  const Estimate* found = explorer.estimating.found();
  return {loaded != nullptr ? loaded->source : "", loaded != nullptr ? loaded->choices : ReadingChoices(),
          explorer.settings(), found != nullptr ? std::optional(*found) : std::nullopt};
}

Copied what_to_copy(const Explorer& explorer) {
  const Settings& settings = explorer.settings();
  const Loaded* loaded = explorer.loaded();
  const auto& shown = explorer.pane(Side::kB).request;
  const auto beam = loaded && shown ? beam_asked(settings, loaded->beams) : std::nullopt;
  if (beam) {
    const auto places_m =
        place_beams(loaded->beams, shown->placement.map->path, shown->placement.offset_s, std::array{*beam});
    return {fmt::format("{:.3f} {:.3f} {:.3f}", places_m[0][0], places_m[0][1], places_m[0][2]),
            "the place of the inspected point in map B, in metres"};
  }
  const Side side = explorer.changed_side();
  return {to_word(Value(offset_ms(settings, side))),
          fmt::format("the offset of map {}, in ms", side == Side::kA ? "A" : "B")};
}

std::string assume_option(const std::optional<RigKind>& assume) {
  if (!assume) return "";
  return *assume == RigKind::kMoving ? " --assume moving" : " --assume stationary";
}

std::string command_line(const Explorer& explorer, int width_px, int height_px) {
  const Loaded* loaded = explorer.loaded();
  const Settings& settings = explorer.settings();
  std::string recording, lines;
  if (loaded != nullptr && loaded->choices.file.empty()) {
    lines += loaded->source + "; wait loaded; ";
  } else if (loaded != nullptr) {
    const ReadingChoices& read = loaded->choices;
    recording = fmt::format(" {}", shell_word(read.file));
    if (!read.poses.empty()) recording += fmt::format(" --poses {}", shell_word(read.poses));
    recording += shell_options(read, true);
  }
  recording += assume_option(explorer.options().assume);
  for (const std::string& line : lines_to_reach(settings)) lines += line + "; ";
  // Said even where it is the default: an estimate leaves alone what a person set.
  if (explorer.estimating.found() != nullptr)
    lines += fmt::format("offset-b {}; estimate; ", settings.offset_b_ms);
  return fmt::format("sweepscope view{} --headless --no-estimate --size {}x{} --run {}", recording, width_px,
                     height_px, shell_word(lines + "wait solved; screenshot picture.png"));
}

}  // namespace sweepscope::ui
