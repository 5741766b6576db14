#include "app/recording_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "app/say.hpp"
#include "app/threads.hpp"
#include "core/io/atomic_file.hpp"
#include "core/io/output_check.hpp"
#include "core/map/offset_map.hpp"
#include "core/memory.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/time_window.hpp"

namespace sweepscope::app {
namespace {

std::optional<double> parse_number(const std::string& text) {
  double number = 0;
  if (text.empty() || !CLI::detail::lexical_cast(text, number) || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<TimeWindow> parse_window(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const auto from_s = parse_number(text.substr(0, colon)), to_s = parse_number(text.substr(colon + 1));
  if (!from_s || !to_s || *from_s >= *to_s) return std::nullopt;
  return TimeWindow{*from_s, *to_s};
}

}  // namespace

void RigOptions::declare_rig(CLI::App& app, const std::string& help_of_rig) {
  app.add_option("--rig", rig, help_of_rig)->type_name("F");
  const auto name = [&app](const char* option, std::optional<std::string>& member, const char* help) {
    app.add_option_function<std::string>(
           option, [&member](const std::string& text) { member = text; }, help)
        ->type_name(std::string(option) == "--joint" ? "NAME" : "TOPIC")
        ->group(kInputGroup);
  };
  name("--laser", streams.laser, "Topic of the scans, if there are several (default: the rig file's)");
  name("--motor", streams.motor,
       "Topic of the motor's angle, if there are several (default: the rig file's)");
  name("--joint", streams.joint, "Joint that turns the laser, if several move (default: the rig file's)");
}

Result<Rig> RigOptions::running_rig() const {
  return rig_given().and_then([](const std::optional<Rig>& given) -> Result<Rig> {
    if (given && given->motor.profile)
      return failure(
          ExitCode::kWrongUsage,
          "a running rig needs messages of its motor: motor.profile of a rig file is used for recordings only");
    return given.value_or(Rig());
  });
}

Result<std::optional<Rig>> RigOptions::rig_given() const {
  std::optional<Rig> given;
  if (rig) {
    auto from_file = read_rig(*rig);
    if (!from_file) return tl::unexpected(std::move(from_file.error()));
    given = std::move(*from_file);
  }
  if (streams.any()) given = with_streams(given.value_or(Rig()), streams);
  return given;
}

void declare_stamps(CLI::App& app, std::optional<StampSource>& stamps) {
  app.add_option_function<std::string>(
         "--stamps",
         [&stamps](const std::string& text) {
           stamps = text == "header" ? StampSource::kHeader : StampSource::kReceive;
         },
         "Stamps to use for both streams (default: the rig file's, else header)")
      ->type_name("S")
      ->group(kInputGroup)
      ->check(CLI::IsMember({"header", "receive"}));
}

void RecordingOptions::declare(CLI::App& app) {
  app.add_option("REC", recording, std::string("The recording: ") + kRecordings)->required();
  declare_reading(app);
}

void RecordingOptions::declare_reading(CLI::App& app) {
  declare_rig(app, "Rig file: topics, joint, stamps and mount (default: detected, rolling about x)");
  declare_stamps(app, stamps);
  app.add_option_function<std::string>(
         "--window", [this](const std::string& text) { window = parse_window(text); },
         "Use only the part from A to B seconds after the first scan")
      ->type_name("A:B")
      ->check([](const std::string& text) {
        return parse_window(text) ? std::string()
                                  : "--window needs A:B in seconds with A less than B, not " + text;
      });
}

void RecordingOptions::declare_computing(CLI::App& app) {
  app.add_option("--assume", assume,
                 "Treat the rig as stationary or moving (default: decided by the motion test)")
      ->type_name("A")
      ->group(kInputGroup)
      ->check(CLI::IsMember({"stationary", "moving"}));
  app.add_option("--threads", threads, "Number of threads (default: all processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
}

std::optional<RigKind> RecordingOptions::assumed_kind() const {
  if (!assume) return std::nullopt;
  return *assume == "moving" ? RigKind::kMoving : RigKind::kStationary;
}

std::unique_ptr<tbb::global_control> RecordingOptions::limit_threads() const {
  return threads <= 0 ? nullptr : app::limit_threads(std::size_t(threads));
}

std::vector<std::filesystem::path> RecordingOptions::input_files() const {
  std::vector<std::filesystem::path> files = recording_files(recording);
  if (rig) files.push_back(*rig);
  return files;
}

Result<ReadOptions> RecordingOptions::read_options() const {
  ReadOptions options;
  options.stamps = stamps;
  options.keep_intensities = keep_intensities;
  auto given = rig_given();
  if (!given) return tl::unexpected(std::move(given.error()));
  options.rig = std::move(*given);
  return options;
}

Result<Recording> RecordingOptions::read(const Job& job) const {
  const auto options = read_options();
  if (!options) return tl::unexpected(options.error());
  return read_fitting(recording, *options, job, window);
}

Result<RecordingFile> RecordingOptions::open(const Job& job) const {
  if (window) return read(job).map([](Recording&& cut) { return RecordingFile(std::move(cut)); });
  return read_options().and_then(
      [&](ReadOptions&& options) { return open_fitting(recording, options, job); });
}

CLI::Validator finite_number() {
  return {[](const std::string& text) {
            double number = 0;
            const bool read = CLI::detail::lexical_cast(text, number);
            return !read || std::isfinite(number) ? std::string() : text + " is not a finite number";
          },
          ""};
}

ExitCode fail(const Error& error) {
  say("sweepscope: {}\n", error.message);
  return error.code;
}

Error too_little_memory(const std::string& input) {
  return {ExitCode::kUnreadableInput, input + ": needs more memory than this machine has"};
}

void print_warnings(const Recording& recording) {
  for (const std::string& warning : recording.report.warnings) {
    say("warning: {}: {}\n", recording.name, warning);
  }
}

Result<void> check_outputs(const std::vector<std::string>& outputs, std::vector<std::filesystem::path> inputs,
                           const std::filesystem::path& folder) {
  RunFiles files{std::move(inputs), {}, folder};
  for (const std::string& output : outputs)
    if (!output.empty() && output != "-") files.outputs.emplace_back(output);
  if (std::count(outputs.begin(), outputs.end(), "-") > 1)
    return failure(ExitCode::kWrongUsage, "only one output can be written to standard output (-)");
  return check_run_files(files);
}

void warn_of_memory(const Recording& recording, std::size_t maps, const Progress& progress) {
  const std::string what = maps == 1 ? "its map" : fmt::format("working on its {} maps", maps);
  const auto warning = memory_warning(what, map_memory_bytes(recording, maps), available_memory_bytes());
  if (warning)
    progress.say(
        fmt::format("warning: {}: {}; --window selects a part of the recording", recording.name, *warning));
}

Result<void> write_text(const std::string& path, const std::string& text) {
  if (path != "-") return write_file(path, text);
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return {};
  const Error error{ExitCode::kWrongUsage,
                    fmt::format("standard output: cannot be written: {}", std::strerror(errno))};
  std::clearerr(stdout);  // said once
  return tl::unexpected(error);
}

}  // namespace sweepscope::app
