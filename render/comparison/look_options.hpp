#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/error.hpp"
#include "render/comparison/comparison.hpp"

namespace sweepscope {

/// One option of how maps are drawn, declared once: the command line's `--name VALUE` and
/// a recipe's `name: value` come from it.
struct LookOption {
  std::string name;  // "colour-by"
  std::string type;  // what a value looks like: "WxH"; empty: a switch, whose value is true or false
  std::string help;  // a sentence
  bool repeats = false;
  /// Sets the option from text. An invalid value is ExitCode::kWrongUsage; the message says what is needed.
  std::function<Result<void>(ComparisonOptions&, const std::string&)> set;
};

std::span<const LookOption> look_options();

/// Sets the option from text; an error begins with its name and the text.
Result<void> set_look(ComparisonOptions& options, const LookOption& option, const std::string& text);

/// The option of that name, or null.
const LookOption* find_look_option(std::string_view name);

}  // namespace sweepscope
