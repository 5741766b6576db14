#pragma once

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/progress.hpp"
#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/recording/formats/recording_file.hpp"
#include "core/recording/rig/named_streams.hpp"
#include "core/recording/time_window.hpp"

namespace sweepscope::app {

/// The kinds of REC, for help texts.
inline constexpr const char* kRecordings =
    "a ROS 1 or ROS 2 bag (.bag, .db3, .mcap), or a folder of either or of CSV tables";
/// Where --help lists the options that say how the input is read.
inline constexpr const char* kInputGroup = "Input";

/// The options that name the laser and the motor of a recording, declared once.
struct RigOptions {
  std::optional<std::filesystem::path> rig;
  StreamNames streams;  // --laser, --motor and --joint

  /// --rig, --laser, --motor and --joint. The options write to this object, which must outlive `app`'s
  /// parsing.
  void declare_rig(CLI::App& app, const std::string& help_of_rig);
  /// The rig file's contents with the streams that are named; empty where nothing is given.
  Result<std::optional<Rig>> rig_given() const;
  /// The same for a rig that is running, whose motor has to be heard.
  Result<Rig> running_rig() const;
};

/// --stamps.
void declare_stamps(CLI::App& app, std::optional<StampSource>& stamps);

/// The options of every subcommand that reads a recording, declared once.
struct RecordingOptions : RigOptions {
  std::filesystem::path recording;
  std::optional<StampSource> stamps;
  std::optional<TimeWindow> window;   // seconds since the first scan
  std::optional<std::string> assume;  // "stationary" or "moving"; empty: the motion test decides
  bool keep_intensities = true;       // of the beams; false if they are not used
  int threads = 0;                    // 0: as many as there are processors

  /// REC, --rig, --laser, --motor, --joint, --stamps and --window. The options write to this object, which
  /// must outlive `app`'s parsing.
  void declare(CLI::App& app);
  /// The same without REC, for a subcommand whose input may be something else.
  void declare_reading(CLI::App& app);
  /// --assume and --threads, of the subcommands that compute.
  void declare_computing(CLI::App& app);
  /// The files that these options read: the recording's and the rig file.
  std::vector<std::filesystem::path> input_files() const;
  /// --assume, if given.
  std::optional<RigKind> assumed_kind() const;
  /// Limits the program to `threads` while the returned object lives.
  std::unique_ptr<tbb::global_control> limit_threads() const;
  /// How it is read, with the rig file's contents.
  Result<ReadOptions> read_options() const;
  /// The recording of these options, cut to the window.
  Result<Recording> read(const Job& job) const;
  /// The same, of which no more is read than what an estimate goes by.
  Result<RecordingFile> open(const Job& job) const;
};

/// A check of an option's number: not NaN, which CLI11's own checks let through, nor infinite.
CLI::Validator finite_number();

/// Prints the error of a subcommand, and returns its exit code.
ExitCode fail(const Error& error);

/// The error for an input that memory does not suffice for.
Error too_little_memory(const std::string& input);
/// Warns, above the bar, if this number of maps of the recording needs more memory than is available.
void warn_of_memory(const Recording& recording, std::size_t maps, const Progress& progress);
/// Prints the warnings of reading on stderr.
void print_warnings(const Recording& recording);
/// Checks what a subcommand will write, before any work: see check_run_files. `outputs` may hold "-", for
/// standard output, at most once; empty names mean no file. `folder`: the folder of the outputs, if the
/// subcommand creates one.
Result<void> check_outputs(const std::vector<std::string>& outputs, std::vector<std::filesystem::path> inputs,
                           const std::filesystem::path& folder = {});
/// Writes to stdout if `path` is "-", otherwise to the file, completely or not at all.
Result<void> write_text(const std::string& path, const std::string& text);

}  // namespace sweepscope::app
