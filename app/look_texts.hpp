#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "render/comparison/look_options.hpp"

namespace sweepscope::app {

/// The look of a picture, as typed on the command line.
struct LookTexts {
  std::map<std::string, std::vector<std::string>> values;

  /// An option of the command for each of look_options(). Writes to this object, which must outlive parsing.
  void declare(CLI::App& command);
  /// An invalid value is ExitCode::kWrongUsage, with a sentence.
  Result<ComparisonOptions> parse() const;
};

}  // namespace sweepscope::app
