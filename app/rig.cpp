#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <string_view>

#include "app/applied_offset.hpp"
#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "core/apply/rig_snippet.hpp"
#include "core/io/atomic_file.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/rig/detect_rig.hpp"
#include "core/results/found_rig.hpp"

namespace sweepscope::app {
namespace {

struct RigArguments {
  std::filesystem::path recording;
  RigOptions rig;
  std::optional<StampSource> stamps;
  std::string output = "-";
  std::optional<RigSystem> system;  // none: the rig file
  std::optional<std::filesystem::path> estimate;
  std::optional<double> offset_ms;
  std::string base_frame = "base_link", motor_frame = "motor_link", laser_frame = "laser";
};

/// --as takes rig files too. They are text, and recordings are not.
bool is_rig_file(const RigArguments& options) {
  std::error_code unknown;
  if (!options.system || !std::filesystem::is_regular_file(options.recording, unknown)) return false;
  std::array<char, 4096> begin{};
  std::ifstream file(options.recording, std::ios::binary);
  file.read(begin.data(), begin.size());
  const std::string_view bytes(begin.data(), static_cast<std::size_t>(file.gcount()));
  return !bytes.empty() && bytes.find('\0') == bytes.npos;
}

Result<DetectedRig> detect(const RigArguments& options) {
  ReadOptions reading;
  reading.stamps = options.stamps;
  auto given = options.rig.rig_given();
  if (!given) return tl::unexpected(given.error());
  reading.rig = std::move(*given);
  const Progress progress;
  const auto found = find_reading(options.recording, reading, progress.job());
  if (!found) return tl::unexpected(found.error());
  if (found->time_increment_s || found->turns_per_s)
    reading.rig =
        with_found(reading.rig.value_or(Rig{}), {found->time_increment_s, std::nullopt, found->turns_per_s});
  return detect_rig(options.recording, reading, progress.job()).map([&](DetectedRig&& detected) {
    if (found->axis && !detected.mount_found) {
      detected.rig.mount.axis = *found->axis;
      detected.mount_note = "as the surfaces show: x rolls, y tilts, z yaws";
    }
    return std::move(detected);
  });
}

/// The rig with what the estimate found of it, if one is given.
Result<DetectedRig> with_estimate(DetectedRig detected, const RigArguments& options) {
  if (!options.estimate) return detected;
  const std::string name = options.estimate->string();
  return read_file(*options.estimate)
      .and_then([&](const std::string& json) { return parse_found_rig(json, name); })
      .and_then([&](const std::optional<SolvedRig>& found) -> Result<DetectedRig> {
        if (!found && options.system) return std::move(detected);
        if (!found)
          return failure(ExitCode::kWrongUsage,
                         name + " has no parameters of the rig: make it with estimate --solve offset,mount");
        return with_found(std::move(detected), *found,
                          "estimate --solve in " + options.estimate->filename().string());
      });
}

/// The rig of a rig file or of a recording, and of the estimate.
Result<DetectedRig> rig_of(const RigArguments& options) {
  const auto known = [&]() -> Result<DetectedRig> {
    if (!is_rig_file(options)) return detect(options);
    return read_rig(options.recording).map([](const Rig& rig) {
      DetectedRig detected;
      detected.rig = rig;
      return detected;
    });
  };
  return known().and_then(
      [&](DetectedRig&& detected) { return with_estimate(std::move(detected), options); });
}

Result<std::string> snippet_text(const RigArguments& options) {
  RigSnippet snippet;
  const auto rig = rig_of(options);
  if (!rig) return tl::unexpected(rig.error());
  snippet.rig = rig->rig;
  const auto offset = applied_offset(options.estimate, options.offset_ms);
  if (!offset) return tl::unexpected(offset.error());
  snippet.offset = *offset;
  snippet.base_frame = options.base_frame;
  snippet.motor_frame = options.motor_frame;
  snippet.laser_frame = options.laser_frame;
  snippet.source = options.recording.filename().string();
  return rig_snippet(snippet, *options.system);
}

Result<void> check_options(const RigArguments& options) {
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  if (options.system && options.estimate.has_value() == options.offset_ms.has_value())
    return refuse("--as writes the offset as well: give one of --estimate and --offset-ms");
  if (!options.system && options.offset_ms) return refuse("--offset-ms belongs to --as");
  if (is_rig_file(options) && (options.rig.rig || options.rig.streams.any() || options.stamps))
    return refuse("--rig, --laser, --motor, --joint and --stamps belong to a recording, not to a rig file");
  return {};
}

std::vector<std::filesystem::path> input_files(const RigArguments& options) {
  std::vector<std::filesystem::path> files = recording_files(options.recording);
  if (is_rig_file(options)) files.push_back(options.recording);
  if (options.rig.rig) files.push_back(*options.rig.rig);
  if (options.estimate) files.push_back(*options.estimate);
  return files;
}

ExitCode run(const RigArguments& options) {
  const auto checked =
      check_options(options).and_then([&] { return check_outputs({options.output}, input_files(options)); });
  if (!checked) return fail(checked.error());
  const auto text = options.system ? snippet_text(options) : rig_of(options).map(rig_file_text);
  if (!text) return fail(text.error());
  const auto written = write_text(options.output, *text);
  return written ? ExitCode::kDone : fail(written.error());
}

void declare_snippet(CLI::App& command, RigArguments& options) {
  command
      .add_option_function<std::string>(
          "--as",
          [&options](const std::string& name) {
            const auto& names = rig_system_names();
            options.system = static_cast<RigSystem>(std::ranges::find(names, name) - names.begin());
          },
          "Write the mount and the offset for this system instead")
      ->type_name("SYSTEM")
      ->check(CLI::IsMember(rig_system_names()));
  command
      .add_option("--estimate", options.estimate,
                  "Estimate (JSON): the rig that its --solve found is written, and with --as its offset")
      ->type_name("E.json");
  command.add_option("--offset-ms", options.offset_ms, "The offset, if there is no estimate")
      ->check(finite_number());
  command.add_option("--base-frame", options.base_frame, "The base frame in what --as writes")
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--motor-frame", options.motor_frame, "The frame that turns with the motor")
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--laser-frame", options.laser_frame, "The laser's frame")
      ->capture_default_str()
      ->type_name("NAME");
}

}  // namespace

void add_rig(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand(
      "rig",
      "Write a rig file with what was detected in a recording, to edit and to pass with --rig; or the mount "
      "and the offset for other systems");
  auto options = std::make_shared<RigArguments>();
  command
      ->add_option("REC", options->recording,
                   std::string("The recording: ") + kRecordings + "; with --as also a rig file")
      ->required();
  command->add_option("-o,--output", options->output, "The file to write (default: stdout)")
      ->type_name("OUT");
  options->rig.declare_rig(
      *command,
      "Rig file with what is already known, or that names the laser and the motor if they "
      "are ambiguous");
  declare_stamps(*command, options->stamps);
  declare_snippet(*command, *options);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
