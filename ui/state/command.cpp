#include "ui/state/command.hpp"

#include <algorithm>

namespace sweepscope::ui {
namespace {

/// What a field without arguments sets: the other state of a switch, the next choice.
std::vector<Value> next_values(const Command& command, const Settings& settings) {
  const Value value = command.get(settings)[0];
  if (const auto* on = std::get_if<bool>(&value)) return {!*on};
  const auto& choices = command.parameters[0].choices;
  const auto at = std::find(choices.begin(), choices.end(), std::get<std::string>(value));
  return {choices[static_cast<std::size_t>(at - choices.begin() + 1) % choices.size()]};
}

}  // namespace

bool Command::moves_on() const {
  return is_field() && parameters.size() == 1 &&
         (parameters[0].kind == Kind::kSwitch || parameters[0].kind == Kind::kChoice);
}

std::string to_line(const Call& call) {
  std::string line = call.command->name;
  for (const Value& value : call.values) line += " " + quoted(to_word(value));
  return line;
}

Settings changed(Settings settings, const Call& call) {
  const Command& command = *call.command;
  if (const auto* edit = std::get_if<Edit>(&command.handler)) {
    edit->set(settings, call.values);
    return settings;
  }
  const bool next = call.values.empty() && command.moves_on();
  std::get<Field>(command.handler).set(settings, next ? next_values(command, settings) : call.values);
  return settings;
}

const Command* find_in(std::span<const Command> commands, std::string_view name) {
  const auto found = std::ranges::find(commands, name, &Command::name);
  return found == commands.end() ? nullptr : &*found;
}

std::vector<std::string> lines_to_reach(const Settings& settings) {
  std::vector<std::string> lines;
  Settings reached;
  for (const Command& command : setting_commands()) {
    if (!command.is_field() || command.get(reached) == command.get(settings)) continue;
    const Call call{&command, command.get(settings)};
    reached = changed(reached, call);
    lines.push_back(to_line(call));
  }
  return lines;
}

}  // namespace sweepscope::ui
