#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"

namespace sweepscope::app {
namespace {

struct ConvertArguments {
  std::filesystem::path recording, output;
  RigOptions rig;
  std::string to, compression = "none";
};

Result<RecordingFormat> format_of(const ConvertArguments& options) {
  const auto format = options.to.empty() ? recording_format_of(options.output) : recording_format(options.to);
  if (!format) {
    return failure(ExitCode::kWrongUsage, fmt::format("{}: unknown format; name it OUT.bag, OUT.mcap, or OUT "
                                                      "for a folder of CSV tables, or use --to",
                                                      options.output.string()));
  }
  if (!can_compress(*format, options.compression)) {
    return failure(ExitCode::kWrongUsage, fmt::format("{}: --compression {} is not available for this format",
                                                      options.output.string(), options.compression));
  }
  return *format;
}

Result<void> check_files(const ConvertArguments& options, RecordingFormat format) {
  std::vector<std::filesystem::path> inputs = recording_files(options.recording);
  if (options.rig.rig) inputs.push_back(*options.rig.rig);
  return check_outputs(written_files(options.output, format), std::move(inputs),
                       format == RecordingFormat::kCsv ? options.output : std::filesystem::path());
}

/// Converts, and gives the line that says so.
Result<std::string> convert(const ConvertArguments& options) {
  const auto format = format_of(options);
  if (!format) return tl::unexpected(format.error());
  if (const auto checked = check_files(options, *format); !checked) return tl::unexpected(checked.error());
  const auto given = options.rig.rig_given();
  if (!given) return tl::unexpected(given.error());
  const Rig rig = given->value_or(Rig());
  const Progress progress;
  const auto raw = read_raw_recording(options.recording, rig, progress.job(), CloudDetail::kWhole);
  if (!raw) return tl::unexpected(raw.error());
  const auto laser = choose_laser(*raw, rig);
  if (!laser) return tl::unexpected(laser.error());
  const auto joint = choose_joint(*raw, rig);
  if (!joint) return tl::unexpected(joint.error());
  const RawLaser& scans = raw->lasers[*laser];
  const RawJoint& motor = raw->joints[*joint];
  const auto written =
      write_recording(scans, motor, *format, options.compression, options.output, progress.job());
  if (!written) return tl::unexpected(written.error());
  for (const std::string& warning : raw->warnings)
    progress.say(fmt::format("warning: {}: {}", raw->name, warning));
  return fmt::format("{}: {} {} of {} and {} samples of {} on {}", options.output.string(),
                     scans.of_clouds ? scans.clouds.size() : scans.scans.size(),
                     scans.of_clouds ? "clouds" : "scans", scans.topic, motor.stamps.size(), motor.joint,
                     motor.topic);
}

ExitCode run(const ConvertArguments& options) {
  const auto said = convert(options);
  if (!said) return fail(said.error());
  print("{}\n", *said);
  return ExitCode::kDone;
}

}  // namespace

void add_convert(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("convert", "Convert the scans and the motor samples to another recording format");
  auto options = std::make_shared<ConvertArguments>();
  command->add_option("REC", options->recording, std::string("The recording: ") + kRecordings)->required();
  command
      ->add_option("-o,--output", options->output,
                   "OUT.bag, OUT.mcap, or OUT for a folder with scans.csv and motor.csv")
      ->required()
      ->type_name("OUT");
  command->add_option("--to", options->to, "csv, ros1 or mcap (default: by the name of OUT)")
      ->type_name("FORMAT")
      ->check([](const std::string& name) {
        return recording_format(name) ? std::string() : name + ": the formats are csv, ros1 and mcap";
      });
  command
      ->add_option("--compression", options->compression,
                   "Chunk compression: none; bz2 or lz4 (ros1); lz4 or zstd (mcap)")
      ->capture_default_str()
      ->type_name("C")
      ->check(CLI::IsMember({"none", "bz2", "lz4", "zstd"}));
  options->rig.declare_rig(*command, "Rig file that names the laser and the motor, if they are ambiguous");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
