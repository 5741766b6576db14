#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/rig/detect_rig.hpp"

namespace sweepscope::app {
namespace {

struct Options {
  std::filesystem::path recording;
  std::optional<std::filesystem::path> rig;
  std::optional<StampSource> stamps;
  std::string output = "-";
};

Result<std::string> detect(const Options& options) {
  ReadOptions reading;
  reading.stamps = options.stamps;
  if (options.rig) {
    auto given = read_rig(*options.rig);
    if (!given) return tl::unexpected(given.error());
    reading.rig = *given;
  }
  const Progress progress;
  return detect_rig(options.recording, reading, progress.job()).map(rig_file_text);
}

std::vector<std::filesystem::path> input_files(const Options& options) {
  std::vector<std::filesystem::path> files = recording_files(options.recording);
  if (options.rig) files.push_back(*options.rig);
  return files;
}

ExitCode run(const Options& options) {
  if (const auto checked = check_outputs({options.output}, input_files(options)); !checked)
    return fail(checked.error());
  const auto text = detect(options);
  if (!text) return fail(text.error());
  const auto written = write_text(options.output, *text);
  return written ? ExitCode::kDone : fail(written.error());
}

}  // namespace

void add_rig(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand(
      "rig", "Write a rig file with what was detected in a recording, to edit and to give with --rig");
  auto options = std::make_shared<Options>();
  command->add_option("REC", options->recording, std::string("The recording: ") + kRecordings)->required();
  command->add_option("-o,--output", options->output, "The rig file (default: stdout)")
      ->type_name("OUT.yaml");
  command
      ->add_option("--rig", options->rig,
                   "Rig file with what is already known, or that names the laser and the motor where that is "
                   "ambiguous")
      ->type_name("F");
  command
      ->add_option_function<std::string>(
          "--stamps",
          [options](const std::string& text) {
            options->stamps = text == "header" ? StampSource::kHeader : StampSource::kReceive;
          },
          "Stamps to use for both streams: header or receive (default: the rig file's, else header)")
      ->type_name("S")
      ->check(CLI::IsMember({"header", "receive"}));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
