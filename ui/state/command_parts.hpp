#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ui/state/commands.hpp"

/// The parts that the table of commands (commands.hpp) is made of.
namespace sweepscope::ui {

/// Commands that set a field of the settings, and those that edit several at once.
void add_settings(std::vector<Command>& all);

/// Commands that do something: open, estimate, export.
void add_actions(std::vector<Command>& all);

/// What every command says of itself.
struct CommandWords {
  std::string name, title, help;
};

inline Parameter number_of(std::string name, std::string unit, double least, double greatest, double step) {
  return {
      .name = std::move(name), .unit = std::move(unit), .least = least, .greatest = greatest, .step = step};
}
inline Parameter choice_of(std::string name, std::vector<std::string> choices) {
  return {.name = std::move(name), .kind = Kind::kChoice, .choices = std::move(choices)};
}
inline Parameter text_of(std::string name) {
  return {.name = std::move(name), .kind = Kind::kText};
}

}  // namespace sweepscope::ui
