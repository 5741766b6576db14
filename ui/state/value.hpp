#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"

namespace sweepscope::ui {

/// The value of a command's parameter: a number, a switch, or text.
using Value = std::variant<double, bool, std::string>;

enum class Kind { kNumber, kSwitch, kChoice, kText };

/// What happens to the file or folder that a text names. The session that is open may be saved again, and a
/// report is several files in a folder.
enum class FileUse { kNone, kRead, kWritten, kSession, kReport };

/// A parameter of a command, declared once: parsing, help, sliders and menus follow from it.
struct Parameter {
  std::string name;
  Kind kind = Kind::kNumber;
  std::string unit = {};
  double least = -1e9, greatest = 1e9, step = 0;  // of a number; step: what a slider or key moves by
  std::vector<std::string> choices = {};
  bool optional = false;
  FileUse file = FileUse::kNone;
  std::string ending = {};  // of a name that is suggested for a file that is written
};

/// The value of a word. An invalid word is ExitCode::kWrongUsage; the message says what is valid.
Result<Value> parse_value(const Parameter& parameter, std::string_view word);

/// The word that parse_value reads back to the same value.
std::string to_word(const Value& value);

/// The words of a line: separated by spaces, with "double quotes" around a word that holds any; # begins a
/// comment.
Result<std::vector<std::string>> split_words(std::string_view line);

/// A word quoted for split_words: in quotes if it is empty or contains spaces, a quote or #.
std::string quoted(const std::string& word);

/// "19 to 29 ms", "on or off", "dark or light": for help.
std::string describe(const Parameter& parameter);

}  // namespace sweepscope::ui
