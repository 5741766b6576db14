#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "ui/state/settings.hpp"
#include "ui/state/value.hpp"

namespace sweepscope::ui {

class Explorer;
class Window;
struct Command;

/// A command with its arguments. Values of optional parameters may be missing at the end.
struct Call {
  const Command* command = nullptr;
  std::vector<Value> values;

  std::string text(std::size_t i) const { return i < values.size() ? to_word(values[i]) : std::string(); }
  double number(std::size_t i) const { return std::get<double>(values.at(i)); }
};

/// Holds one part of the settings. Without arguments a switch toggles and a choice takes its next value.
struct Field {
  std::function<std::vector<Value>(const Settings&)> get;
  std::function<void(Settings&, const std::vector<Value>&)> set;
};
/// Changes settings relative to their current values.
struct Edit {
  std::function<void(Settings&, const std::vector<Value>&)> set;
};
/// Carried out by the explorer.
struct Action {
  std::function<Result<void>(Explorer&, const Call&)> run;
};
/// Carried out by the explorer's window; an error without one.
struct WindowAction {
  std::function<Result<void>(Explorer&, Window&, const Call&)> run;
};
using Handler = std::variant<Field, Edit, Action, WindowAction>;

/// What must be there before a command makes sense. A script waits for it where it is under way.
enum class Need { kNothing, kRecording, kEstimate, kMaps };

/// A command of the explorer, for clicks, keys, the palette and scripts. Declared once, with its handler.
struct Command {
  std::string name;   // in scripts: "offset-a"
  std::string title;  // for people: "Offset of map A"
  std::string help;   // one or two sentences, also the tooltip
  std::vector<Parameter> parameters;
  Handler handler;
  Need needs = Need::kNothing;
  bool moves_view = false;  // by a person: it is not fitted to the map from then on

  bool is_field() const { return std::holds_alternative<Field>(handler); }
  /// Of a field.
  std::vector<Value> get(const Settings& settings) const { return std::get<Field>(handler).get(settings); }
  /// Whether it may be called without its argument: a field that toggles or takes its next value.
  bool moves_on() const;
};

/// What a command says of itself.
struct CommandWords {
  std::string name, title, help;
};

/// The line that parse_call (ui/commands/commands.hpp) reads back.
std::string to_line(const Call& call);
/// The settings after a field or an edit.
Settings changed(Settings settings, const Call& call);

/// All fields and edits.
std::span<const Command> setting_commands();
/// Null if there is none of that name.
const Command* find_in(std::span<const Command> commands, std::string_view name);
/// The fields that make these settings from the default ones, as lines.
std::vector<std::string> lines_to_reach(const Settings& settings);

inline Parameter number_of(std::string name, std::string unit, double least, double greatest, double step) {
  return {
      .name = std::move(name), .unit = std::move(unit), .least = least, .greatest = greatest, .step = step};
}
inline Parameter choice_of(std::string name, std::vector<std::string> choices) {
  return {.name = std::move(name), .kind = Kind::kChoice, .choices = std::move(choices)};
}
inline Parameter switch_of(std::string name) {
  return {.name = std::move(name), .kind = Kind::kSwitch};
}
inline Parameter text_of(std::string name) {
  return {.name = std::move(name), .kind = Kind::kText};
}
inline Parameter optional_of(Parameter parameter) {
  parameter.optional = true;
  return parameter;
}

}  // namespace sweepscope::ui
