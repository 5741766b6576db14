#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"

namespace sweepscope::app {
namespace {

ExitCode run(const RecordingOptions& options) {
  const Progress progress;
  const auto recording = options.read(progress.job());
  if (!recording) return fail(recording.error());
  print_warnings(*recording);
  fmt::print("{}: {} scans, {} motor samples\n", recording->name, recording->scans.size(),
             recording->motor.time_s.size());
  return ExitCode::kDone;
}

}  // namespace

void add_info(CLI::App& app, ExitCode& exit_code) {
  CLI::App* info =
      app.add_subcommand("info", "Show what a recording holds and what an estimate can hope for");
  const auto options = std::make_shared<RecordingOptions>();
  options->declare(*info);
  info->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
