#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "ui/state/settings.hpp"
#include "ui/state/value.hpp"

namespace sweepscope::ui {

/// What must be there before a command makes sense. A script waits for it where it is under way.
enum class Need { kNothing, kRecording, kEstimate, kPoints, kPlaces };

/// A command of the explorer, for clicks, keys, the palette and scripts. Declared once.
///  - A field command (`get` and `set`) holds one part of the settings. Without arguments a switch
///    toggles and a choice takes its next value.
///  - An edit (only `set`) changes settings relative to their current values.
///  - An action (neither) is executed by the explorer or its window.
struct Command {
  std::string name;   // in scripts: "offset-a"
  std::string title;  // for people: "Offset of map A"
  std::string help;   // one or two sentences, also the tooltip
  std::vector<Parameter> parameters = {};
  std::function<std::vector<Value>(const Settings&)> get = {};
  std::function<void(Settings&, const std::vector<Value>&)> set = {};
  Need needs = Need::kNothing;

  bool is_field() const { return get != nullptr; }
  bool is_action() const { return set == nullptr; }
};

std::span<const Command> commands();
/// Null if there is none of that name.
const Command* find_command(std::string_view name);

/// A command with its arguments. Values of optional parameters may be missing at the end.
struct Call {
  const Command* command = nullptr;
  std::vector<Value> values;

  std::string text(std::size_t i) const { return i < values.size() ? to_word(values[i]) : std::string(); }
  double number(std::size_t i) const { return std::get<double>(values.at(i)); }
};

/// The call of a line such as `layout swipe`. Unknown names, and missing, excess or invalid arguments are
/// ExitCode::kWrongUsage.
Result<Call> parse_call(std::string_view line);
/// The line that parse_call reads back.
std::string to_line(const Call& call);

/// The settings after a field command or an edit.
Settings changed(Settings settings, const Call& call);

/// A shortcut: a key chord such as "Ctrl+Shift+Z" and its line.
struct Shortcut {
  std::string chord;
  std::string line;
  std::string title = {};  // if neither a menu's nor the command's title fits
};
std::span<const Shortcut> shortcuts();
/// The first chord of a line; empty where it has none.
std::string chord_of(std::string_view line);

/// An entry of the menu bar, in order; an empty line is a separator.
struct MenuItem {
  std::string menu;
  std::string title;
  std::string line;
};
std::span<const MenuItem> menu_items();

/// The field commands that make these settings from the default ones, as lines.
std::vector<std::string> lines_to_reach(const Settings& settings);

}  // namespace sweepscope::ui
