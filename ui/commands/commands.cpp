#include "ui/commands/commands.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/nearest_word.hpp"
#include "ui/explorer/explorer.hpp"

namespace sweepscope::ui {
namespace {

std::string unknown_command(const std::string& word) {
  std::vector<std::string> names;
  for (const Command& command : commands()) names.push_back(command.name);
  const std::string nearest = nearest_word(word, names);
  return fmt::format("There is no command \"{}\"{}", word,
                     nearest.empty() ? "" : fmt::format(". Did you mean \"{}\"?", nearest));
}

std::size_t needed(const Command& command) {
  return static_cast<std::size_t>(std::ranges::count(command.parameters, false, &Parameter::optional));
}

}  // namespace

std::span<const Command> commands() {
  static const std::vector<Command> all = [] {
    const auto settings = setting_commands();
    std::vector<Command> joined(settings.begin(), settings.end());
    for (const auto& part : {opening_commands, map_commands, file_commands, window_commands})
      std::ranges::move(part(), std::back_inserter(joined));
    return joined;
  }();
  return all;
}

const Command* find_command(std::string_view name) {
  return find_in(commands(), name);
}

std::string usage_of(const Command& command) {
  std::string text = command.name;
  for (const Parameter& parameter : command.parameters)
    text += parameter.optional ? " [" + parameter.name + "]" : " " + parameter.name;
  return text;
}

Result<Call> parse_call(std::string_view line) {
  const auto words = split_words(line);
  if (!words) return tl::unexpected(words.error());
  if (words->empty()) return not_now("An empty line names no command");
  Call call{find_command(words->front()), {}};
  if (call.command == nullptr) return not_now(unknown_command(words->front()));
  const Command& command = *call.command;
  const std::size_t given = words->size() - 1;
  if (given == 0 && command.moves_on()) return call;
  if (given < needed(command) || given > command.parameters.size())
    return not_now("The command is: " + usage_of(command));
  for (std::size_t i = 0; i < given; ++i) {
    auto value = parse_value(command.parameters[i], (*words)[i + 1]);
    if (!value) return not_now(command.name + ": " + value.error().message);
    call.values.push_back(std::move(*value));
  }
  return call;
}

Result<void> Explorer::perform(std::string_view line, const std::string& gesture) {
  return parse_call(line).and_then([&](const Call& call) { return perform(call, gesture); });
}

}  // namespace sweepscope::ui
