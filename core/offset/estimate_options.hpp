#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/offset/prepared/options.hpp"

namespace sweepscope {

/// One option of an estimate, declared once: the command line's `--name VALUE`, a recipe's `name: value` and
/// the explorer's choices come from it.
struct EstimateOption {
  std::string name;                  // "weight-c"
  std::string type;                  // what a value looks like: "FROM:TO:STEP"
  std::string help;                  // a sentence
  std::vector<std::string> choices;  // all valid values; empty: see `type`
  bool repeats = false;              // it may be given more than once
  bool value_optional = false;       // then `set` takes an empty text as well
  /// Sets the option from text. An invalid value is ExitCode::kWrongUsage; the message says what is needed.
  std::function<Result<void>(EstimateOptions&, const std::string&)> set;
};

/// All options, in the order of the help.
std::span<const EstimateOption> estimate_options();
/// The option of that name, or null.
const EstimateOption* find_estimate_option(std::string_view name);

}  // namespace sweepscope
