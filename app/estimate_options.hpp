#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/recording_options.hpp"
#include "core/offset/estimator.hpp"
#include "core/results/candidate_file.hpp"

namespace sweepscope::app {

/// The input of an estimate: the recording, and how the offset is searched for. `estimate` and `merge` read
/// the same options.
struct EstimateInput {
  RecordingOptions recording;
  EstimateOptions estimate;

  /// Declares REC and every option. They write to this object, which must outlive `app`'s parsing.
  void declare(CLI::App& app);
};

/// Declares the options of an estimate that have these names, or all of them if there are none, below this
/// heading of --help. They write to `estimate`, which must outlive the parsing.
void declare_estimate_options(CLI::App& command, EstimateOptions& estimate,
                              std::initializer_list<std::string_view> names = {},
                              const std::string& heading = "Options");

/// The outputs of the result.
struct EstimateOutput {
  std::string json, csv;
  bool no_timing = false;

  void declare(CLI::App& app);
  /// --json alone, and the others below this heading.
  void declare_json(CLI::App& app);
  void declare_others(CLI::App& app, const std::string& heading);
  bool on_stdout() const { return json == "-" || csv == "-"; }
  /// See check_outputs; `others` are outputs besides these.
  Result<void> check(std::vector<std::filesystem::path> inputs, std::vector<std::string> others = {}) const;
  Result<void> write(const Estimate& estimate) const;
};

/// The options that `command` was given and that decide what a candidate's values are, as "--range=19:29:1":
/// all of them except those for paths, output and threads.
std::vector<std::string> deciding_options(const CLI::App& command);

/// The search that candidates computed from these options belong to.
Result<CandidateSearch> candidate_search(const RecordingOptions& recording, std::vector<std::string> options);

/// The candidates that a command keeps while it works, in a file that it removes once its output is written.
Result<std::unique_ptr<CandidateFile>> keep_while_working(const std::filesystem::path& path,
                                                          const RecordingOptions& recording,
                                                          std::vector<std::string> deciding);
/// The error of failed work: after an interruption it says what is kept. An empty file is removed.
Error ended(Error error, CandidateFile& kept);

/// Writes the result, and prints the answer on stdout unless a file goes there; also if a file cannot be
/// written, so that the result is not lost. Returns the exit code.
ExitCode conclude(const Estimate& estimate, const EstimateOutput& output);

}  // namespace sweepscope::app
