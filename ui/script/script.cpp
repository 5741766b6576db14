#include "ui/script/script.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ui/commands/commands.hpp"
#include "ui/explorer/observables.hpp"

namespace sweepscope::ui {

Result<Script> parse_script(std::string_view text, std::string_view name, bool semicolons) {
  Script script{std::string(name), {}};
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find_first_of(semicolons ? ";\n" : "\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    auto words = split_words(line);
    if (!words)
      return failure(ExitCode::kWrongUsage, fmt::format("{}:{}: {}", name, number, words.error().message));
    if (!words->empty()) script.lines.push_back({number, std::move(*words), std::string(line)});
  }
  return script;
}

std::string script_help() {
  std::string text =
      "A script is a list of lines; # begins a comment. Besides the commands below:\n"
      "  click PLACE, double-click PLACE, hover PLACE      PLACE: X Y in pixels, or a name in quotes, such "
      "as\n"
      "                                                    \"map a\", \"handle b\", \"button estimate\", "
      "\"chart 0\" at 0.2 0.5\n"
      "  drag PLACE to PLACE [BUTTON], drag PLACE by X Y   BUTTON: left, right or middle\n"
      "  mouse move PLACE, mouse down|up [BUTTON], wheel CLICKS\n"
      "  key CHORD, type TEXT, drop FILE                   CHORD: H, 7, Space, Ctrl+Shift+Z ...\n"
      "  wait loaded|estimated|solved [SECONDS], frames N\n"
      "  screenshot FILE.png                               the whole interface, once its pictures are complete\n"
      "  film FOLDER [SECONDS], film off                   a picture each 0.1 s (or SECONDS) of what is seen on "
      "the way\n"
      "  expect NAME is|contains TEXT, expect NAME near VALUE WITHIN, expect NAME above|below VALUE\n"
      "  expect picture FILE.png                           the same picture, within the limits for pictures\n"
      "  wander ACTIONS [SEED]                             tries everything in a random order that SEED "
      "sets;\n"
      "                                                    exports go to the working folder\n"
      "What can be expected:\n";
  for (const auto& [name, meaning] : observables()) text += fmt::format("  {:<20} {}\n", name, meaning);
  text += "Commands (without an argument, a setting toggles or takes its next value):\n";
  for (const Command& command : commands()) {
    std::string words;
    for (const Parameter& parameter : command.parameters) {
      if (parameter.kind == Kind::kChoice) words += " " + parameter.name + ": " + describe(parameter) + ".";
    }
    text += fmt::format("  {:<34} {}{}\n", usage_of(command), command.help, words);
  }
  return text;
}

}  // namespace sweepscope::ui
