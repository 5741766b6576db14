#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "app/applied_offset.hpp"
#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/apply/apply.hpp"
#include "core/apply/apply_files.hpp"
#include "core/apply/sweep_folder.hpp"

namespace sweepscope::app {
namespace {

namespace fs = std::filesystem;

struct ApplyArguments {
  fs::path recording, output;
  std::optional<fs::path> estimate;
  RigOptions rig;
  std::optional<double> offset_ms;
  std::optional<StampSource> stamps;
  std::string shift = "motor";
  bool again = false, far = false;
  std::string clouds_topic, base_frame = "base_link", clouds_format = "pcd";
  std::optional<fs::path> clouds_only, poses;
  std::optional<std::string> assume;
  bool transforms = false;
};

/// Whether the output may be written, before anything is read.
Result<void> check_files(const ApplyArguments& options) {
  std::vector<fs::path> others;
  for (const auto& file : {options.estimate, options.rig.rig, options.poses})
    if (file) others.push_back(*file);
  return check_apply_files(options.recording, options.output, options.clouds_only, std::move(others));
}

Result<ApplyOptions> apply_options(const ApplyArguments& options) {
  ApplyOptions result;
  const auto offset = applied_offset(options.estimate, options.offset_ms);
  if (!offset) return tl::unexpected(offset.error());
  result.offset = *offset;
  if (options.estimate) result.estimate = options.estimate->filename().string();
  result.shifted = options.shift == "laser" ? ShiftedStream::kLaser : ShiftedStream::kMotor;
  result.again = options.again;
  result.far = options.far;
  result.stamps = options.stamps;
  const auto rig = options.rig.rig_given();
  if (!rig) return tl::unexpected(rig.error());
  result.rig = rig->value_or(Rig());
  result.add.clouds_topic = options.clouds_topic;
  result.add.transforms = options.transforms;
  result.add.base_frame = options.base_frame;
  result.add.poses = options.poses;
  if (options.assume)
    result.add.map.assume = *options.assume == "moving" ? RigKind::kMoving : RigKind::kStationary;
  return result;
}

/// What contradicts itself, whatever the files hold.
Result<void> check_options(const ApplyArguments& options) {
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  if (options.estimate.has_value() == options.offset_ms.has_value())
    return refuse("apply needs the offset: one of --estimate and --offset-ms");
  if (options.output.empty() && !options.clouds_only)
    return refuse("apply needs an output: -o OUT, or --clouds-only DIR");
  const bool adds = !options.clouds_topic.empty() || options.transforms;
  if (adds && options.output.empty())
    return refuse("--clouds and --tf add topics to a recording: name it with -o OUT");
  if (options.poses && options.clouds_topic.empty() && !options.clouds_only)
    return refuse("--poses is used by --clouds and --clouds-only");
  return {};
}

Result<void> write_clouds(const ApplyArguments& options, const ApplyOptions& apply_options,
                          const Progress& progress) {
  const auto written = write_applied_sweeps(options.recording, apply_options, *options.clouds_only,
                                            "." + options.clouds_format, progress.job());
  if (!written) return tl::unexpected(written.error());
  for (const std::string& warning : written->warnings) progress.say("warning: " + warning);
  print("{}: {} sweeps of a {} rig, and poses.tum\n", options.clouds_only->string(), written->sweeps,
        written->moving ? "moving" : "stationary");
  return {};
}

Result<Applied> write_recording(const ApplyArguments& options, const ApplyOptions& apply_options,
                                const Progress& progress) {
  auto applied = apply_offset(options.recording, options.output, apply_options, progress.job());
  if (!applied) return applied;
  for (const std::string& warning : applied->warnings)
    progress.say(fmt::format("warning: {}: {}", options.recording.filename().string(), warning));
  return applied;
}

void print_applied(const Applied& applied, const fs::path& output) {
  const Provenance& done = applied.provenance;
  print("{}: {} {} of {} moved by {:+.6f} ms{}, onto the {}'s clock{}{}\n", output.string(), applied.moved,
        done.stamp == StampSource::kHeader ? "header stamps" : "receive times", done.topic,
        (done.shifted == ShiftedStream::kMotor ? -1e3 : 1e3) * done.offset.offset_s,
        done.offset.changes() ? " (changing over time)" : "",
        done.shifted == ShiftedStream::kMotor ? "laser" : "motor",
        done.added.empty() ? "" : "; added: ", fmt::format("{}", fmt::join(done.added, ", ")));
}

Result<void> run_checked(const ApplyArguments& options) {
  if (const auto checked = check_options(options); !checked) return checked;
  if (const auto checked = check_files(options); !checked) return checked;
  const auto apply_options = app::apply_options(options);
  if (!apply_options) return tl::unexpected(apply_options.error());
  const Progress progress;
  if (options.clouds_only)
    if (auto written = write_clouds(options, *apply_options, progress); !written) return written;
  if (options.output.empty()) return {};
  return write_recording(options, *apply_options, progress).map([&](const Applied& applied) {
    print_applied(applied, options.output);
  });
}

ExitCode run(const ApplyArguments& options) {
  const auto done = run_checked(options);
  return done ? ExitCode::kDone : fail(done.error());
}

void declare_clouds(CLI::App& command, ApplyArguments& options) {
  constexpr const char* kGroup = "Clouds and transforms";
  command
      .add_option("--clouds", options.clouds_topic,
                  "Add each sweep as a sensor_msgs/PointCloud2 on this topic, in the base frame of its first "
                  "beam, with the motion of the motor and of the rig removed")
      ->type_name("TOPIC")
      ->group(kGroup);
  command
      .add_flag("--tf", options.transforms,
                "Add the laser's pose in the base frame to /tf, at each of the motor's samples")
      ->group(kGroup);
  command
      .add_option("--clouds-only", options.clouds_only,
                  "Write each sweep as a file in this new folder, and their poses (poses.tum); works for "
                  "CSV tables too, and without -o")
      ->type_name("DIR")
      ->group(kGroup);
  command.add_option("--clouds-format", options.clouds_format, "Files of --clouds-only: pcd or ply")
      ->capture_default_str()
      ->group(kGroup)
      ->check(CLI::IsMember({"pcd", "ply"}));
  command
      .add_option("--poses", options.poses,
                  "Trajectory of the rig (TUM), used instead of solving for it to remove its motion")
      ->type_name("F")
      ->group(kGroup);
  command
      .add_option("--assume", options.assume,
                  "stationary or moving, instead of the motion test; stationary leaves the rig's motion in "
                  "the clouds")
      ->group(kGroup)
      ->check(CLI::IsMember({"stationary", "moving"}));
  command.add_option("--base-frame", options.base_frame, "The frame of the clouds and the parent in /tf")
      ->capture_default_str()
      ->group(kGroup)
      ->type_name("NAME");
}

}  // namespace

void add_apply(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command =
      app.add_subcommand("apply", "Write the recording with the offset applied to the stamps");
  auto options = std::make_shared<ApplyArguments>();
  command->add_option("REC", options->recording, "The recording: a ROS 1 or ROS 2 bag, or an MCAP file")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "OUT.bag, OUT.mcap, OUT.db3, or OUT for the folder of a ROS 2 bag")
      ->type_name("OUT");
  command->add_option("--estimate", options->estimate, "Estimate (JSON) whose offset is applied")
      ->type_name("E.json");
  command->add_option("--offset-ms", options->offset_ms, "The offset, if there is no estimate")
      ->check(finite_number());
  command
      ->add_option("--shift", options->shift,
                   "motor: move its stamps onto the laser's clock; laser: the other way")
      ->capture_default_str()
      ->check(CLI::IsMember({"motor", "laser"}));
  options->rig.declare_rig(
      *command, "Rig file that names the laser, the motor and their stamps, if they are ambiguous");
  declare_stamps(*command, options->stamps);
  command->add_flag("--again", options->again, "Apply it even if an offset was applied before");
  command->add_flag("--far", options->far, "Apply it even if it is longer than the motor's period");
  declare_clouds(*command, *options);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
