#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "app/commands.hpp"
#include "app/estimate_options.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/say.hpp"
#include "core/live/calibration.hpp"
#include "core/live/foxglove_source.hpp"
#include "core/live/ros_source.hpp"
#include "core/live/stream_source.hpp"
#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/formats/recording_writer.hpp"

namespace sweepscope::app {
namespace {

struct CalibrateArguments {
  std::string source, address;  // the address: of a Foxglove server
  RecordingOptions recording;   // --rig, --laser, --motor, --joint, --stamps and --threads
  CalibrationOptions calibration;
  std::filesystem::path record;
  EstimateOutput output;
};

constexpr const char* kLines =
    "\nStandard input holds the lines of a CSV recording's two tables in the order in which they arrive, "
    "each with the word scan or motor in front. The first line of each kind names its columns:\n"
    "  scan,stamp_s,angle_min_rad,angle_increment_rad,time_increment_s,ranges_m\n"
    "  motor,stamp_s,angle_rad\n"
    "  motor,1700000000.000,0.0131\n"
    "  scan,1700000000.004,-1.5708,0.004363,1.736e-5,3.21 3.20 nan 3.22\n"
    "Columns are those of the tables (docs/recordings.md): stamp_s and/or receive_s in s; angle_min_rad, "
    "angle_increment_rad, ranges_m in m with spaces between them [intensities, time_increment_s, "
    "scan_time_s, "
    "range_min_m, range_max_m, topic]; angle_rad, angle_deg or position [topic, joint]. Empty lines and "
    "lines that begin with # are ignored.";

Result<std::unique_ptr<LiveSource>> open_source(const CalibrateArguments& options) {
  if (options.source == "-")
    return std::make_unique<StreamSource>(STDIN_FILENO, "standard input", options.calibration.rig);
  if (options.source == "foxglove") return open_foxglove_source(options.address, options.calibration.rig);
  return open_ros_source(options.calibration.rig);
}

Result<RecordingFormat> record_format(const std::filesystem::path& output) {
  if (const auto format = recording_format_of(output)) return *format;
  return failure(
      ExitCode::kWrongUsage,
      fmt::format("{}: unknown format; name it OUT.bag, OUT.mcap, or OUT for a folder of CSV tables",
                  output.string()));
}

Result<void> keep(const RawRecording& heard, const CalibrateArguments& options, RecordingFormat format) {
  const auto laser = choose_laser(heard, options.calibration.rig);
  if (!laser) return tl::unexpected(laser.error());
  const auto joint = choose_joint(heard, options.calibration.rig);
  if (!joint) return tl::unexpected(joint.error());
  return write_recording(heard.lasers[*laser], heard.joints[*joint], format, "none", options.record, Job());
}

void tell_running(const Progress& progress, const HeardSoFar& heard, const Result<Estimate>& answer) {
  const std::string what = !answer            ? answer.error().message
                           : answer->offset_s ? fmt::format("{:.3f} ms +- {:.3f} ms", *answer->offset_s * 1e3,
                                                            answer->sigma_s.value_or(0) * 1e3)
                                              : answer->refusals.front().text;
  progress.say(fmt::format("{:5.1f} s, {} scans, {} motor samples: {}", heard.seconds, heard.scans,
                           heard.motor_samples, what.substr(0, what.find('\n'))));
}

std::string words_of(ListeningEnd end, const HeardSoFar& heard, const CalibrationOptions& options) {
  const std::string much = fmt::format("{:.1f} of {:g} s", heard.seconds, options.seconds);
  switch (end) {
    case ListeningEnd::kHeardEnough:
      return "";
    case ListeningEnd::kInputEnded:
      return fmt::format("The input ended after {}.", much);
    case ListeningEnd::kSilence:
      return fmt::format("No new data arrived for {:g} s, after {}.", options.silence_s, much);
    case ListeningEnd::kNoScans:
      return fmt::format("No scan arrived for {:g} s, after {}; {} motor samples were received.",
                         options.silence_s, much, heard.motor_samples);
    case ListeningEnd::kStampsStandStill:
      return fmt::format(
          "The scans' stamps did not advance for {:g} s: {} scans were received, the last one stamped {:.3f} "
          "s after the first one.",
          options.silence_s, heard.scans, heard.seconds);
    case ListeningEnd::kTooMuch:
      return fmt::format("More data arrived than is kept, after {}: {} scans and {} motor samples.", much,
                         heard.scans, heard.motor_samples);
    case ListeningEnd::kCancelled:
      return fmt::format("Interrupted after {}.", much);
  }
  return "";
}

/// Lines may come from a file that is standard input.
Result<void> check_files(const CalibrateArguments& options, RecordingFormat format) {
  std::vector<std::filesystem::path> inputs;
  if (options.source == "-") inputs.emplace_back("/dev/stdin");
  if (options.recording.rig) inputs.push_back(*options.recording.rig);
  std::vector<std::string> outputs{options.output.json, options.output.csv};
  if (!options.record.empty())
    for (const std::string& file : written_files(options.record, format)) outputs.push_back(file);
  return check_outputs(outputs, std::move(inputs),
                       format == RecordingFormat::kCsv ? options.record : std::filesystem::path());
}

/// What ended the listening before its time is why there is no answer, too.
bool is_a_reason(ListeningEnd end) {
  return end == ListeningEnd::kNoScans || end == ListeningEnd::kStampsStandStill ||
         end == ListeningEnd::kTooMuch;
}

/// `kept`: whether what was heard could be recorded.
Result<Estimate> run_calibration(CalibrateArguments& options, Result<void>& kept) {
  if ((options.source == "foxglove") == options.address.empty())
    return failure(ExitCode::kWrongUsage,
                   options.address.empty()
                       ? "calibrate foxglove needs an address, such as ws://localhost:8765"
                       : "an address belongs to calibrate foxglove");
  const auto rig = options.recording.running_rig();
  if (!rig) return tl::unexpected(rig.error());
  options.calibration.rig = *rig;
  options.calibration.stamps = options.recording.stamps;
  auto format = options.record.empty() ? RecordingFormat::kCsv : record_format(options.record);
  if (!format) return tl::unexpected(format.error());
  const auto checked = check_files(options, *format);
  if (!checked) return tl::unexpected(checked.error());
  const Progress progress;
  auto source = open_source(options);
  if (!source) return tl::unexpected(source.error());
  finish_after_first_interrupt();
  const auto end = listen(**source, options.calibration, progress.job(),
                          [&](const HeardSoFar& heard, const Result<Estimate>& answer) {
                            tell_running(progress, heard, answer);
                          });
  if (!end) return tl::unexpected(end.error());
  RawRecording heard = (*source)->heard();
  const std::string ended = words_of(*end, heard_so_far(heard), options.calibration);
  if (!ended.empty()) heard.warnings.push_back(ended);
  if (!options.record.empty()) kept = keep(heard, options, *format);
  // What was heard is used after an interruption as well.
  auto found = calibrate(std::move(heard), options.calibration, Job());
  if (found && !found->identifiable && is_a_reason(*end))
    found->refusals.insert(found->refusals.begin(), refusal(RefusalKind::kListeningEnded, {}, ended));
  if (!kept && !found) return tl::unexpected(kept.error());
  if (!kept) found->warnings.push_back(fmt::format("Nothing was recorded: {}", kept.error().message));
  return found;
}

ExitCode run(CalibrateArguments& options) {
  const auto threads = options.recording.limit_threads();
  Result<void> kept;
  const auto found = run_calibration(options, kept);
  if (!found) return fail(found.error());
  const ExitCode code = conclude(*found, options.output);
  return kept || code != ExitCode::kDone ? code : fail(kept.error());
}

}  // namespace

void add_calibrate(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "Find the offset of a running, stationary rig: t_motor = t_laser + offset");
  const auto options = std::make_shared<CalibrateArguments>();
  const bool ros = ros_source_is_built();
  const std::string sources =
      ros ? "- for lines on standard input, or ros for a running ROS 1 system, or foxglove with an address"
          : "- for lines on standard input, or foxglove with an address (a running ROS 1 system: not built in "
            "here)";
  command->add_option("SOURCE", options->source, sources)
      ->required()
      ->check(CLI::IsMember(ros ? std::vector<std::string>{"-", "ros", "foxglove"}
                                : std::vector<std::string>{"-", "foxglove"}));
  command->add_option("ADDRESS", options->address,
                      "ws://HOST:PORT of a Foxglove WebSocket server, such as ROS 2's foxglove_bridge");
  command
      ->add_option("--seconds", options->calibration.seconds, "How long to listen, in seconds of scan stamps")
      ->check(finite_number())
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str()
      ->type_name("S");
  command
      ->add_option("--silence-s", options->calibration.silence_s,
                   "Stop listening after this many seconds without a newer scan")
      ->check(finite_number())
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str()
      ->type_name("S");
  command
      ->add_option(
          "--record", options->record,
          "Record what was received: OUT.bag, OUT.mcap, or OUT for a folder with scans.csv and motor.csv")
      ->type_name("OUT");
  options->recording.declare_rig(
      *command, "Rig file: topics, joint, stamps and mount (default: detected, rolling about x)");
  declare_stamps(*command, options->recording.stamps);
  command
      ->add_option_function<std::string>(
          "--method",
          [options](const std::string& text) {
            options->calibration.estimate.method = text == "direct" ? Method::kDirect : Method::kStationary;
          },
          "direct (default) or stationary, as in estimate")
      ->type_name("M")
      ->check(CLI::IsMember({"direct", "stationary"}));
  declare_estimate_options(*command, options->calibration.estimate, {"search"}, "Options");
  command->add_option("--threads", options->recording.threads, "Number of threads (default: all processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  options->output.declare(*command);
  command->footer(kLines);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
