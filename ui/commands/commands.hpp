#pragma once

#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "ui/state/command.hpp"

namespace sweepscope::ui {

/// All commands of the explorer, the settings first.
std::span<const Command> commands();
/// Null if there is none of that name.
const Command* find_command(std::string_view name);

/// The call of a line such as `layout swipe`. Unknown names, and missing, excess or invalid arguments are
/// ExitCode::kWrongUsage.
Result<Call> parse_call(std::string_view line);
/// "play [STATE]": a command with its parameters.
std::string usage_of(const Command& command);

template <typename Run, typename... Arguments>
Result<void> done(const Run& run, Arguments&... arguments) {
  if constexpr (std::is_void_v<std::invoke_result_t<Run, Arguments&...>>) {
    run(arguments...);
    return {};
  } else {
    return run(arguments...);
  }
}

/// An action: `run` takes the explorer and the call, and returns Result<void>, or nothing where it cannot
/// fail.
template <typename Run>
Command action(CommandWords words, std::vector<Parameter> parameters, Run run, Need needs = Need::kNothing) {
  const auto carry_out = [run](Explorer& explorer, const Call& call) { return done(run, explorer, call); };
  return {words.name, words.title, words.help, std::move(parameters), Action{carry_out}, needs};
}
/// The same in a window, which `run` takes after the explorer.
template <typename Run>
Command window_action(CommandWords words, std::vector<Parameter> parameters, Run run,
                      Need needs = Need::kNothing) {
  const auto carry_out = [run](Explorer& explorer, Window& window, const Call& call) {
    return done(run, explorer, window, call);
  };
  return {words.name, words.title, words.help, std::move(parameters), WindowAction{carry_out}, needs};
}

/// The parts of the table, in its order after the settings.
std::vector<Command> opening_commands();
std::vector<Command> map_commands();
std::vector<Command> file_commands();
std::vector<Command> window_commands();

/// A name for the file that a command such as "save-session" writes, in the working folder; empty where it
/// writes none. `what`: of an export of one map, "a" or "b".
std::string suggested_file(const Explorer& explorer, const std::string& command, const std::string& what);

/// A shortcut: a key chord such as "Ctrl+Shift+Z" and its line.
struct Shortcut {
  std::string chord;
  std::string line;
  std::string title = {};  // if neither a menu's nor the command's title fits
};
std::span<const Shortcut> shortcuts();
/// The first chord of a line; empty where it has none.
std::string chord_of(std::string_view line);
/// Other words for a line, for a search; empty without any.
std::string_view synonyms_of(std::string_view line);

/// An entry of the menu bar, in order; an empty line is a separator.
struct MenuItem {
  std::string menu;
  std::string line;
  std::string title = {};  // empty in the table: the command's
};
std::span<const MenuItem> menu_items();
/// In the order of the menu bar.
std::vector<std::string> menu_names();

/// What commands do in the window of an explorer.
class Window {
 public:
  Window() = default;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  virtual ~Window() = default;

  virtual void quit() = 0;
  /// What is in front: it is shown in place of anything else, or taken away where it is shown already.
  virtual void toggle_palette() = 0;
  virtual void toggle_keys() = 0;
  /// Empty size or parts: the usual ones.
  virtual Result<void> export_figure(const std::string& file, const std::string& size,
                                     const std::string& parts) = 0;
  /// The dialog that asks for the file of a command, and `what` of it.
  virtual void ask(const std::string& command, const std::string& what) = 0;
  virtual void dismiss() = 0;
  virtual void open_menu(const std::string& name) = 0;
  virtual void type_into_next_field(bool back) = 0;
  virtual void copy(const std::string& text) = 0;
  /// See command_line (ui/explorer/observables.hpp).
  virtual std::string command_line() const = 0;
  /// `what`: "maps" or "everything"; `size`: such as "3840x2400", or empty.
  virtual Result<void> export_picture(const std::string& file, const std::string& what,
                                      const std::string& size) = 0;
};

}  // namespace sweepscope::ui
