#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "ui/script/recorder.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {

/// The actions of a person as lines: see script_help.
struct Script {
  struct Line {
    int number = 0;
    std::vector<std::string> words;
    std::string text;
  };
  std::string name;  // for messages
  std::vector<Line> lines;
};

/// Lines end at a line break, and at ";" if `semicolons`.
Result<Script> parse_script(std::string_view text, std::string_view name, bool semicolons = false);

/// How long a script waits at most, unless a line says otherwise.
inline constexpr double kMaxWait_s = 600;

/// Runs it with frames of 1/60 s, at most `max_s` for each wait. The first line that fails ends the script,
/// with one sentence that names file and line: ExitCode::kImageDiffers for an expectation, kWrongUsage for an
/// invalid line, otherwise the error of the command. `recorder`: gets all of it, with the places of events in
/// pixels; may be null.
Result<void> run_script(Ui& ui, const Script& script, double max_s = kMaxWait_s,
                        ScriptRecorder* recorder = nullptr);

/// Lists all kinds of lines, for `view --help`.
std::string script_help();

}  // namespace sweepscope::ui
