#include <map>

#include "ui/state/command_parts.hpp"

namespace sweepscope::ui {
namespace {

/// Settings need nothing but those of a place in the recording, which are forgotten when one is opened.
Need need_of(const std::string& name) {
  static const std::map<std::string, Need> kNeeds{
      {"time", Need::kRecording},           {"box", Need::kRecording},
      {"box-here", Need::kRecording},       {"colour-range", Need::kRecording},
      {"pick", Need::kRecording},           {"profile", Need::kRecording},
      {"measure", Need::kRecording},        {"fit-view", Need::kRecording},
      {"estimate", Need::kRecording},       {"solve", Need::kRecording},
      {"save-session", Need::kRecording},   {"copy-command", Need::kRecording},
      {"export-picture", Need::kRecording}, {"export-report", Need::kRecording},
      {"play", Need::kRecording},           {"next-place", Need::kPlaces},
      {"look-at-place", Need::kPlaces},     {"take-found", Need::kEstimate},
      {"export-curve", Need::kEstimate},    {"export-rig", Need::kEstimate},
      {"use-rig", Need::kEstimate},         {"export-cloud", Need::kPoints}};
  const auto need = kNeeds.find(name);
  return need == kNeeds.end() ? Need::kNothing : need->second;
}

std::vector<Command> make_commands() {
  std::vector<Command> all;
  add_settings(all);
  add_actions(all);
  for (Command& command : all) command.needs = need_of(command.name);
  return all;
}

}  // namespace

std::span<const Command> commands() {
  static const std::vector<Command> all = make_commands();
  return all;
}

}  // namespace sweepscope::ui
