#pragma once

#include <CLI/CLI.hpp>

#include "core/error.hpp"

namespace sweepscope::app {

/// Each declares one subcommand on `app`: its options, and a callback that runs it and stores the exit code.
/// One file per subcommand, without algorithms.
void add_estimate(CLI::App& app, ExitCode& exit_code);
void add_calibrate(CLI::App& app, ExitCode& exit_code);
void add_live(CLI::App& app, ExitCode& exit_code);
void add_merge(CLI::App& app, ExitCode& exit_code);
void add_view(CLI::App& app, ExitCode& exit_code);
void add_compare(CLI::App& app, ExitCode& exit_code);
void add_map(CLI::App& app, ExitCode& exit_code);
void add_report(CLI::App& app, ExitCode& exit_code);
void add_figures(CLI::App& app, ExitCode& exit_code);
void add_info(CLI::App& app, ExitCode& exit_code);
void add_rig(CLI::App& app, ExitCode& exit_code);
void add_apply(CLI::App& app, ExitCode& exit_code);
void add_convert(CLI::App& app, ExitCode& exit_code);
void add_simulate(CLI::App& app, ExitCode& exit_code);

}  // namespace sweepscope::app
