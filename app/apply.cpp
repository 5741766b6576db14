#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/apply/apply.hpp"
#include "core/io/atomic_file.hpp"
#include "core/recording/formats/read_raw_recording.hpp"

namespace sweepscope::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path recording, output;
  std::optional<fs::path> estimate, rig;
  std::optional<double> offset_ms;
  std::optional<std::string> stamps;
  std::string shift = "motor";
  bool again = false;
};

Result<AppliedOffset> offset_of(const Options& options) {
  if (!options.estimate) {
    AppliedOffset offset;
    offset.offset_s = *options.offset_ms * 1e-3;
    return offset;
  }
  return read_file(*options.estimate).and_then([&](const std::string& json) {
    return parse_applied_offset(json, options.estimate->string());
  });
}

/// Whether the output may be written, before anything is read.
Result<void> check_files(const Options& options) {
  std::vector<fs::path> inputs = recording_files(options.recording);
  for (const auto& file : {options.estimate, options.rig})
    if (file) inputs.push_back(*file);
  const bool folder = !options.output.has_filename() || options.output.extension().empty();
  if (folder) return check_outputs({(options.output / "metadata.yaml").string()}, inputs, options.output);
  return check_outputs({options.output.string()}, std::move(inputs));
}

Result<Applied> apply(const Options& options) {
  if (options.estimate.has_value() == options.offset_ms.has_value())
    return failure(ExitCode::kWrongUsage, "apply needs the offset: one of --estimate and --offset-ms");
  if (const auto checked = check_files(options); !checked) return tl::unexpected(checked.error());
  ApplyOptions apply_options;
  const auto offset = offset_of(options);
  if (!offset) return tl::unexpected(offset.error());
  apply_options.offset = *offset;
  if (options.estimate) apply_options.estimate = options.estimate->filename().string();
  apply_options.shifted = options.shift == "laser" ? ShiftedStream::kLaser : ShiftedStream::kMotor;
  apply_options.again = options.again;
  if (options.stamps)
    apply_options.stamps = *options.stamps == "header" ? StampSource::kHeader : StampSource::kReceive;
  if (options.rig) {
    auto rig = read_rig(*options.rig);
    if (!rig) return tl::unexpected(rig.error());
    apply_options.rig = std::move(*rig);
  }
  const Progress progress;
  auto applied = apply_offset(options.recording, options.output, apply_options, progress.job());
  if (!applied) return applied;
  for (const std::string& warning : applied->warnings)
    progress.say(fmt::format("warning: {}: {}", options.recording.filename().string(), warning));
  return applied;
}

ExitCode run(const Options& options) {
  const auto applied = apply(options);
  if (!applied) return fail(applied.error());
  const Provenance& done = applied->provenance;
  print("{}: {} {} of {} moved by {:+.6f} ms{}, onto the {}'s clock\n", options.output.string(),
        applied->moved, done.stamp == StampSource::kHeader ? "header stamps" : "receive times", done.topic,
        (done.shifted == ShiftedStream::kMotor ? -1e3 : 1e3) * done.offset.offset_s,
        done.offset.changes() ? " (changing over time)" : "",
        done.shifted == ShiftedStream::kMotor ? "laser" : "motor");
  return ExitCode::kDone;
}

}  // namespace

void add_apply(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("apply", "Write the recording with the offset applied to the stamps");
  auto options = std::make_shared<Options>();
  command->add_option("REC", options->recording, "The recording: a ROS 1 or ROS 2 bag, or an MCAP file")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "OUT.bag, OUT.mcap, OUT.db3, or OUT for the folder of a ROS 2 bag")
      ->required()
      ->type_name("OUT");
  command->add_option("--estimate", options->estimate, "Estimate (JSON) whose offset is applied")
      ->type_name("E.json");
  command->add_option("--offset-ms", options->offset_ms, "The offset, where there is no estimate")
      ->check(finite_number());
  command
      ->add_option("--shift", options->shift,
                   "motor: move its stamps onto the laser's clock; laser: the other way")
      ->capture_default_str()
      ->check(CLI::IsMember({"motor", "laser"}));
  command
      ->add_option("--rig", options->rig,
                   "Rig file that names the laser, the motor and their stamps, where that is ambiguous")
      ->type_name("F");
  command
      ->add_option("--stamps", options->stamps,
                   "Stamps that are used: header or receive (default: the rig file's, else header)")
      ->type_name("S")
      ->check(CLI::IsMember({"header", "receive"}));
  command->add_flag("--again", options->again, "Also where an offset was applied before");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
