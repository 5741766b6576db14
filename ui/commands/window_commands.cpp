#include <algorithm>

#include "ui/commands/commands.hpp"

namespace sweepscope::ui {
namespace {

/// The commands whose file a dialog can ask for.
std::vector<std::string> commands_with_files() {
  std::vector<std::string> names;
  for (const auto& part : {opening_commands, file_commands})
    for (const Command& command : part())
      if (std::ranges::any_of(command.parameters,
                              [](const Parameter& p) { return p.file != FileUse::kNone; }))
        names.push_back(command.name);
  return names;
}

std::vector<std::string> words_for_menus() {
  std::vector<std::string> words = menu_names();
  for (std::string& word : words) word[0] = static_cast<char>(word[0] - 'A' + 'a');
  return words;
}

}  // namespace

std::vector<Command> window_commands() {
  return {
      window_action({"palette", "All commands", "A searchable list of all commands."}, {},
                    [](Explorer&, Window& window, const Call&) { window.toggle_palette(); }),
      window_action({"help", "Keys", "The list of keys."}, {},
                    [](Explorer&, Window& window, const Call&) { window.toggle_keys(); }),
      window_action({"dismiss", "Close the front window", "The palette, a dialog, a message, or the tool."},
                    {}, [](Explorer&, Window& window, const Call&) { window.dismiss(); }),
      window_action(
          {"ask", "Ask for a file", "Shows the dialog that asks for a command's file."},
          {choice_of("COMMAND", commands_with_files()),
           optional_of(choice_of("WHAT", {"a", "b", "everything", "maps"}))},
          [](Explorer&, Window& window, const Call& call) { window.ask(call.text(0), call.text(1)); }),
      window_action({"menu", "Open a menu", "Shows it, for the arrow keys, Enter and Escape."},
                    {choice_of("MENU", words_for_menus())},
                    [](Explorer&, Window& window, const Call& call) { window.open_menu(call.text(0)); }),
      window_action(
          {"next-field", "Next field", "Types into the next number; \"back\": into the previous one."},
          {optional_of(choice_of("WAY", {"back"}))},
          [](Explorer&, Window& window, const Call& call) {
            window.type_into_next_field(!call.values.empty());
          }),
      window_action({"quit", "Quit", "Ends the program."}, {},
                    [](Explorer&, Window& window, const Call&) { window.quit(); }),
  };
}

}  // namespace sweepscope::ui
