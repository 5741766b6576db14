#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/estimate_options.hpp"
#include "app/progress.hpp"

namespace sweepscope::app {
namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> parts;
  std::string recording, rig;  // empty: where the parts say
  int threads = 0;
  EstimateOutput output;
};

/// The options with which the parts were computed, read by the same declarations.
Result<std::unique_ptr<EstimateInput>> input_of(const CandidateSearch& search,
                                                const MergeArguments& options) {
  auto input = std::make_unique<EstimateInput>();
  CLI::App reader;
  input->declare(reader);
  std::vector<std::string> words{options.recording.empty() ? search.recording : options.recording};
  words.insert(words.end(), search.options.begin(), search.options.end());
  if (!search.rig_hash.empty()) words.push_back("--rig=" + (options.rig.empty() ? search.rig : options.rig));
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    reader.parse(words);
  } catch (const CLI::ParseError& error) {
    return unreadable(
        fmt::format("{}: its options are not valid: {}", options.parts.front().string(), error.what()));
  }
  input->recording.threads = options.threads;
  return input;
}

/// Hashes of what was found must be those that the parts name.
Result<void> check(const EstimateInput& input, const CandidateSearch& search, const MergeArguments& options) {
  return candidate_search(input.recording, search.options).and_then([&](const CandidateSearch& here) {
    const std::string differs = difference(search, here);
    if (differs.empty()) return Result<void>();
    return Result<void>(
        failure(ExitCode::kWrongUsage, fmt::format("{}: {}", options.parts.front().string(), differs)));
  });
}

Result<Estimate> merge(const MergeArguments& options, MergedCandidates& candidates) {
  const CandidateSearch& search = candidates.search();
  const auto input = input_of(search, options);
  if (!input) return tl::unexpected(input.error());
  const auto threads = (*input)->recording.limit_threads();
  const auto checked = options.output.check((*input)->recording.input_files()).and_then([&] {
    return check(**input, search, options);
  });
  if (!checked) return tl::unexpected(checked.error());
  const Progress progress;
  auto recording = (*input)->recording.read(progress.job());
  if (!recording) return tl::unexpected(recording.error());
  recording->name = std::filesystem::path(search.recording).filename().string();
  EstimateOptions estimate_options = (*input)->estimate;
  estimate_options.assume = (*input)->recording.assumed_kind();
  auto found = estimate(*recording, estimate_options, {&candidates, {}}, progress.job());
  if (!found) return found;
  if (found->interrupted) return failure(ExitCode::kInterrupted, "interrupted");
  if (const auto missing = candidates.missing()) return tl::unexpected(*missing);
  return found;
}

ExitCode run(const MergeArguments& options) {
  if (const auto checked = options.output.check(options.parts); !checked) return fail(checked.error());
  auto candidates = MergedCandidates::read(options.parts);
  if (!candidates) return fail(candidates.error());
  const auto found = merge(options, *candidates);
  if (!found) return fail(found.error());
  return conclude(*found, options.output);
}

}  // namespace

void add_merge(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("merge", "Combine the parts of `estimate --shard` into one result");
  auto options = std::make_shared<MergeArguments>();
  command->add_option("PART", options->parts, "Candidate files of one search")->required()->expected(-1);
  command
      ->add_option("--recording", options->recording,
                   "Path of the recording, which is read again (default: as named in the parts)")
      ->type_name("REC");
  command->add_option("--rig", options->rig, "Path of the rig file (default: as named in the parts)")
      ->type_name("F");
  command->add_option("--threads", options->threads, "Number of threads (default: all processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  options->output.declare(*command);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace sweepscope::app
