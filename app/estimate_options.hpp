#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/recording_options.hpp"
#include "core/offset/estimator.hpp"
#include "core/results/candidate_file.hpp"

namespace sweepscope::app {

/// What to estimate from: the recording, and how the offset is looked for. `estimate` and `merge` read the
/// same options.
struct EstimateInput {
  RecordingOptions recording;
  EstimateOptions estimate;

  /// The options write to this object, which must outlive `app`'s parsing.
  void declare(CLI::App& app);
};

/// Where the result goes.
struct EstimateOutput {
  std::string json, csv;
  bool no_timing = false;

  void declare(CLI::App& app);
  bool on_stdout() const { return json == "-" || csv == "-"; }
  /// See check_outputs; `others` are outputs besides these.
  Result<void> check(std::vector<std::filesystem::path> inputs, std::vector<std::string> others = {}) const;
  Result<void> write(const Estimate& estimate) const;
};

/// The options that `command` was given and that decide what a candidate's values are, as "--range=19:29:1":
/// all of them but those that say where things lie, how they are shown, or on how many threads.
std::vector<std::string> deciding_options(const CLI::App& command);

/// What candidates computed from these options belong to.
Result<CandidateSearch> candidate_search(const RecordingOptions& recording, std::vector<std::string> options);

/// What a command keeps of its work while it is at it, in a file that it takes away once what it makes is
/// written.
Result<std::unique_ptr<CandidateFile>> keep_while_working(const std::filesystem::path& path,
                                                          const RecordingOptions& recording,
                                                          std::vector<std::string> deciding);
/// The error of work that failed: where it was interrupted it says what is kept. A file that holds nothing is
/// taken away.
Error ended(Error error, CandidateFile& kept);

/// Writes the result, and says the answer on stdout, unless a file goes there: also where a file cannot be
/// written, so that nothing that was found is lost. Gives the exit code.
ExitCode conclude(const Estimate& estimate, const EstimateOutput& output);

}  // namespace sweepscope::app
