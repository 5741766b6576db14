#include "ui/state/commands.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/nearest_word.hpp"

namespace sweepscope::ui {
namespace {

tl::unexpected<Error> wrong(std::string message) {
  return failure(ExitCode::kWrongUsage, std::move(message));
}

std::string usage(const Command& command) {
  std::string text = command.name;
  for (const Parameter& parameter : command.parameters) {
    text += parameter.optional ? " [" + parameter.name + "]" : " " + parameter.name;
  }
  return text;
}

std::string unknown_command(const std::string& word) {
  std::vector<std::string> names;
  for (const Command& command : commands()) names.push_back(command.name);
  const std::string nearest = nearest_word(word, names);
  return fmt::format("There is no command \"{}\"{}", word,
                     nearest.empty() ? "" : fmt::format(". Did you mean \"{}\"?", nearest));
}

std::size_t needed(const Command& command) {
  return static_cast<std::size_t>(std::count_if(command.parameters.begin(), command.parameters.end(),
                                                [](const Parameter& p) { return !p.optional; }));
}

/// What a field command without arguments sets: the other state of a switch, the next choice.
std::vector<Value> next_values(const Command& command, const Settings& settings) {
  Value value = command.get(settings)[0];
  if (const auto* on = std::get_if<bool>(&value)) return {!*on};
  const auto& choices = command.parameters[0].choices;
  const auto at = std::find(choices.begin(), choices.end(), std::get<std::string>(value));
  return {choices[static_cast<std::size_t>(at - choices.begin() + 1) % choices.size()]};
}

bool moves_on(const Command& command) {
  return command.is_field() && command.parameters.size() == 1 &&
         (command.parameters[0].kind == Kind::kSwitch || command.parameters[0].kind == Kind::kChoice);
}

}  // namespace

const Command* find_command(std::string_view name) {
  const auto all = commands();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Command& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Result<Call> parse_call(std::string_view line) {
  const auto words = split_words(line);
  if (!words) return tl::unexpected(words.error());
  if (words->empty()) return wrong("An empty line names no command");
  Call call;
  call.command = find_command(words->front());
  if (call.command == nullptr) return wrong(unknown_command(words->front()));
  const Command& command = *call.command;
  const std::size_t given = words->size() - 1;
  if (given == 0 && moves_on(command)) return call;
  if (given < needed(command) || given > command.parameters.size())
    return wrong(fmt::format("The command is: {}", usage(command)));
  for (std::size_t i = 0; i < given; ++i) {
    auto value = parse_value(command.parameters[i], (*words)[i + 1]);
    if (!value) return wrong(command.name + ": " + value.error().message);
    call.values.push_back(std::move(*value));
  }
  return call;
}

std::string to_line(const Call& call) {
  std::string line = call.command->name;
  for (const Value& value : call.values) line += " " + quoted(to_word(value));
  return line;
}

Settings changed(Settings settings, const Call& call) {
  const bool next = call.values.empty() && moves_on(*call.command);
  call.command->set(settings, next ? next_values(*call.command, settings) : call.values);
  return settings;
}

std::string chord_of(std::string_view line) {
  for (const Shortcut& shortcut : shortcuts()) {
    if (shortcut.line == line) return shortcut.chord;
  }
  return {};
}

std::vector<std::string> lines_to_reach(const Settings& settings) {
  std::vector<std::string> lines;
  Settings reached;
  for (const Command& command : commands()) {
    if (!command.is_field() || command.get(reached) == command.get(settings)) continue;
    const Call call{&command, command.get(settings)};
    reached = changed(reached, call);
    lines.push_back(to_line(call));
  }
  return lines;
}

}  // namespace sweepscope::ui
