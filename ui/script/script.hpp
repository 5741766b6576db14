#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {

/// What a person would do, as lines: see script_help.
struct Script {
  struct Line {
    int number = 0;
    std::vector<std::string> words;
    std::string text;
  };
  std::string name;  // for messages
  std::vector<Line> lines;
};

/// Lines end at a line's end, and at ";" where `semicolons`.
Result<Script> parse_script(std::string_view text, std::string_view name, bool semicolons = false);

/// Runs it with frames of 1/60 s, at most `max_s` for each wait. The first line that fails ends it with one
/// sentence that names file and line: ExitCode::kImageDiffers for an expectation, kWrongUsage for a line that
/// cannot be understood, else what the command failed with.
Result<void> run_script(Ui& ui, const Script& script, double max_s = 600);

/// The lines that there are, for `view --help`.
std::string script_help();

}  // namespace sweepscope::ui
