#include "ui/explorer/hints.hpp"

#include <algorithm>
#include <cctype>

#include "core/io/printable_text.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/state/reading_choices.hpp"

namespace sweepscope::ui {
namespace {

bool is_file(const Explorer& explorer) {
  return explorer.loaded() != nullptr && !explorer.loaded()->choices.file.empty();
}

bool has_rig_file(const Explorer& explorer) {
  return is_file(explorer) && !explorer.loaded()->choices.rig_file.empty();
}

bool is_part(const Explorer& explorer) {
  return is_file(explorer) && explorer.loaded()->choices.window.has_value();
}

bool has_stationary_part(const Explorer& explorer) {
  return is_file(explorer) && stationary_part(explorer).has_value();
}

bool was_not_solved_for_rig(const Explorer& explorer) {
  const Estimate* found = explorer.estimating.found();
  return found == nullptr || !found->rig;
}

bool can_use_receive_stamps(const Explorer& explorer) {
  return is_file(explorer) && explorer.loaded()->choices.stamps != StampSource::kReceive;
}

bool can_use_header_stamps(const Explorer& explorer) {
  return is_file(explorer) && explorer.loaded()->choices.stamps != StampSource::kHeader;
}

/// `sign`: the code of a refusal, or words of a remark that has no code.
struct HintEntry {
  const char *sign, *title, *line;
  bool (*helps)(const Explorer&) = nullptr;  // null: always
};

// In the order of the buttons.
const std::vector<HintEntry> kHints{
    {"rig_moved", "Use the part in which it was stationary", "reopen stationary-part", has_stationary_part},
    {"moved_too_far", "Use the part in which it was stationary", "reopen stationary-part",
     has_stationary_part},
    {"sweeps_apart", "Use the part in which it was stationary", "reopen stationary-part",
     has_stationary_part},
    {"track_lost", "Use the part in which it was stationary", "reopen stationary-part", has_stationary_part},
    {"short_walk", "Use the part in which it was stationary", "reopen stationary-part", has_stationary_part},
    {"long_sweeps", "Use the part in which it was stationary", "reopen stationary-part", has_stationary_part},
    {"in which the rig was stationary, is used", "Use the part in which it was stationary",
     "reopen stationary-part", has_stationary_part},
    {"in which the rig was stationary, is used", "Show the whole recording", "reopen whole", is_part},
    {"rig_moved", "Use the method for moving rigs", "estimate moving"},
    {"one_way_at_one_speed", "Solve for the mount", "estimate mount", was_not_solved_for_rig},
    {"(--solve offset,mount)", "Solve for the mount", "estimate mount", was_not_solved_for_rig},
    {"--solve mount", "Solve for the mount", "estimate mount", was_not_solved_for_rig},
    {"(--solve offset,encoder)", "Solve for the encoder", "estimate encoder"},
    {"one_way_motor_and_criteria", "Use the direct method", "estimate direct"},
    {"scan_lines_do_not_repeat", "Use the stationary method", "estimate stationary"},
    {"clocks_drift", "Estimate over time", "estimate over-time"},
    {"offset_jumps", "Estimate over time", "estimate over-time"},
    {"offset_changes", "Estimate over time", "estimate over-time"},
    {"--over-time", "Estimate over time", "estimate over-time"},
    {"--stamps receive", "Use receive stamps", "reopen receive-stamps", can_use_receive_stamps},
    {"uneven_scan_times", "Use header stamps", "reopen header-stamps", can_use_header_stamps},
    {"about another axis", "Use the recording's transforms", "reopen without-rig-file", has_rig_file},
    {"about another axis", "Choose a rig file …", "choose", is_file},
    {"two_motor_sources", "Choose another motor …", "choose", is_file},
    {"motor_does_not_move", "Choose another motor …", "choose", is_file},
    {"few_motor_samples", "Choose another motor …", "choose", is_file},
    {"motor_gaps", "Choose another motor …", "choose", is_file},
    {"hardly_radians", "Choose a rig file …", "choose", is_file},
    {"beam_times_unknown", "Choose a rig file …", "choose", is_file},
};

template <typename Applies>
std::vector<Hint> those_that(const Explorer& explorer, const Applies& applies) {
  std::vector<Hint> hints;
  for (const HintEntry& entry : kHints) {
    const bool is_there =
        std::ranges::any_of(hints, [&](const Hint& hint) { return hint.line == entry.line; });
    if (!is_there && applies(entry.sign) && (entry.helps == nullptr || entry.helps(explorer)))
      hints.push_back({entry.title, entry.line});
  }
  return hints;
}

bool are_said(const std::vector<std::string>& remarks, std::string_view words) {
  return std::ranges::any_of(remarks,
                             [&](const std::string& remark) { return remark.find(words) != remark.npos; });
}

/// Why not even a map of all heights and times would show a point.
std::string why_nothing_is_placed(const Loaded& loaded) {
  const MotorSummary& motor = loaded.summary.motor;
  if (loaded.beams.size() == 0) return "No range of this recording can be used.";
  if (!motor.turns) return "The motor does not turn: without its sweeps there is no map.";
  if (loaded.prepared.motor.sweeps.empty()) return "The motor makes no whole sweep: there is nothing to map.";
  return "No scan has samples of the motor around it at this offset.";
}

}  // namespace

std::string without_options(std::string text) {
  for (const std::string_view begin : {" (--", " (estimate --", " (`estimate --"})
    for (std::size_t at = 0; (at = text.find(begin, at)) != text.npos;)
      text.erase(at, text.find(')', at) - at + 1);
  for (const std::string_view words : {"; consider --stamps receive"})
    if (const std::size_t at = text.find(words); at != text.npos) text.erase(at, words.size());
  for (std::size_t at = 0; (at = text.find("+- ", at)) != text.npos;) text.replace(at, 3, "± ");
  return text;
}

std::string sentence(const std::string& text) {
  std::string words = with_named_axes(without_options(printable_line(text)));
  if (words.empty()) return words;
  const bool begins_with_file = words.substr(0, words.find(' ')).ends_with(':');
  if (!begins_with_file) words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  if (words.back() != '.' && words.back() != '!' && words.back() != ':') words += '.';
  return words;
}

std::optional<RecordingPart> stationary_part(const Explorer& explorer) {
  const Loaded* loaded = explorer.loaded();
  if (loaded == nullptr || loaded->choices.window) return std::nullopt;
  const Estimate* found = explorer.estimating.found();
  return found != nullptr && found->stationary_part ? found->stationary_part
                                                    : loaded->summary.stationary_part;
}

std::vector<Hint> hints_for(const Explorer& explorer, const Estimate& estimate) {
  return those_that(explorer, [&](std::string_view sign) {
    const bool refused = std::ranges::any_of(
        estimate.refusals, [&](const Refusal& refusal) { return entry_of(refusal.kind).code == sign; });
    return refused || are_said(estimate.warnings, sign) || are_said(estimate.reasons(), sign);
  });
}

std::vector<Hint> hints_for(const Explorer& explorer, const std::vector<std::string>& remarks) {
  return those_that(explorer, [&](std::string_view sign) { return are_said(remarks, sign); });
}

EmptyPane empty_pane(const Explorer& explorer, const Pane& pane) {
  if (!pane.request || !pane.best() || !pane.best()->beams.empty()) return {};
  if (!pane.problem.empty() && pane.state != PaneState::kSolved)
    return {pane.problem, hints_for(explorer, std::vector{pane.problem})};
  const Settings& s = explorer.settings();
  if (pane.request->placement.map->order.chosen.empty())
    return {why_nothing_is_placed(*explorer.loaded()), {}};
  std::vector<Hint> hints;
  if (s.time_to_s > s.time_from_s) hints.push_back({"Show all times", "time-window 0 0"});
  if (s.has_box()) hints.push_back({"No clipping box", "box 0 0 0 0 0 0"});
  if (s.heights != Heights::kAll) hints.push_back({"Show all heights", "heights all"});
  return {"No point lies within the heights, times and clipping box that are shown.", hints};
}

}  // namespace sweepscope::ui
