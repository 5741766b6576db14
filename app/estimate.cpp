#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>

#include "app/campaign.hpp"
#include "app/commands.hpp"
#include "app/estimate_options.hpp"
#include "app/progress.hpp"
#include "app/say.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/results/found_rig.hpp"
#include "core/together/estimate_together.hpp"

namespace sweepscope::app {
namespace {

struct EstimateArguments {
  CampaignOptions campaign;
  EstimateInput input;  // its recording: the single one
  EstimateOutput output;
  std::string poses;  // a trajectory from elsewhere; empty: none
  bool trust_poses = false;
  std::string rig_out;  // empty: the rig is not written
  std::string resume;   // empty: candidates are not kept
  std::optional<Shard> shard;
};

std::optional<Shard> parse_shard(const std::string& text) {
  Shard shard;
  const char *begin = text.data(), *end = begin + text.size();
  const auto [slash, first] = std::from_chars(begin, end, shard.number);
  if (first != std::errc() || slash == end || *slash != '/') return std::nullopt;
  const auto [after, second] = std::from_chars(slash + 1, end, shard.count);
  if (second != std::errc() || after != end || shard.number < 1 || shard.count < shard.number)
    return std::nullopt;
  return shard;
}

/// "walk.2-of-4.candidates", in the folder that the command runs in.
std::string shard_file(const EstimateArguments& options) {
  return fmt::format("{}.{}-of-{}.candidates", options.input.recording.recording.stem().string(),
                     options.shard->number, options.shard->count);
}

Result<std::unique_ptr<CandidateFile>> open_candidates(const EstimateArguments& options,
                                                       const std::string& path,
                                                       std::vector<std::string> deciding) {
  return candidate_search(options.input.recording, std::move(deciding))
      .and_then([&](CandidateSearch&& search) {
        search.shard = options.shard;
        return CandidateFile::open(path, search);
      });
}

ExitCode say_shard(const EstimateArguments& options, const Estimate& estimate,
                   const CandidateFile& candidates, const std::string& path) {
  for (const std::string& reason : estimate.reasons()) print("nothing to compute: {}\n", reason);
  print(
      "{}: {} candidates, {} of them computed now; shard {} of {}; combine the shards with `sweepscope "
      "merge`\n",
      path, candidates.held(), candidates.held() - candidates.taken_up(), options.shard->number,
      options.shard->count);
  return ExitCode::kDone;
}

ExitCode conclude_interrupted(const EstimateArguments& options, const Estimate& found,
                              const CandidateFile* candidates) {
  if (!options.shard) {
    if (const auto written = options.output.write(found); !written) return fail(written.error());
  }
  return fail(
      {ExitCode::kInterrupted, candidates == nullptr ? "interrupted" : candidates->interrupted_in_words()});
}

/// The rig as it was solved for.
Result<void> write_rig(const EstimateArguments& options, const Estimate& found) {
  if (options.rig_out.empty() || !found.rig) return {};
  return write_text(options.rig_out, found_rig_file(*found.rig, found.recording));
}

ExitCode conclude_search(const EstimateArguments& options, const Estimate& found, CandidateFile* candidates,
                         const std::string& path) {
  if (found.interrupted) return conclude_interrupted(options, found, candidates);
  const auto ordered = candidates == nullptr ? Result<void>() : candidates->put_in_order();
  if (options.shard) return ordered ? say_shard(options, found, *candidates, path) : fail(ordered.error());
  ExitCode code = conclude(found, options.output);
  if (found.identifiable && options.campaign.expected)
    code = conclude_expectation(*options.campaign.expected, found, !options.output.on_stdout());
  if (const auto written = write_rig(options, found); !written) return fail(written.error());
  return ordered ? code : fail(ordered.error());
}

bool keeps(const EstimateArguments& options) {
  return options.shard || !options.resume.empty();
}

/// What makes no sense together is refused before a file for candidates is begun.
Result<void> check_options(const EstimateArguments& options) {
  const EstimateOptions& search = options.input.estimate;
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  if (options.trust_poses && options.poses.empty()) return refuse("--trust-poses needs --poses T.tum");
  if (!options.poses.empty() && method_of(search, RigKind::kMoving, keeps(options)) != Method::kDirect)
    return refuse(
        "--poses is used by the direct method only: leave out --method and the options of candidates");
  if (!options.rig_out.empty() && !search.solve.any())
    return refuse("--rig-out writes what --solve found: add --solve mount, play or encoder");
  if (options.shard && (!options.output.json.empty() || !options.output.csv.empty()))
    return refuse("--shard computes candidates only: give --json and --csv to merge");
  if (options.shard && options.campaign.expected)
    return refuse("--shard computes candidates only: --expect cannot be combined with it");
  if (options.shard && search.ranges.empty() && !search.around)
    return refuse("--shard needs --range or --around: the default search chooses its candidates as it goes");
  if (search.over_time_s && method_of(search, RigKind::kMoving, keeps(options)) != Method::kDirect)
    return refuse(
        "--over-time is used by the direct method only: leave out --method and the options of candidates");
  if (search.method == Method::kDirect && keeps(options))
    return refuse("the direct method has no candidates: leave out --shard and --resume");
  return {};
}

// What makes no sense for several recordings that have one answer.
Result<void> check_together(const EstimateArguments& options) {
  const auto refuse = [](const std::string& what) { return failure(ExitCode::kWrongUsage, what); };
  if (options.campaign.recordings.size() < 2) return refuse("--together needs at least two recordings");
  if (keeps(options)) return refuse("--together has no candidates: leave out --shard and --resume");
  if (!options.campaign.table.empty() || !options.campaign.trend.empty())
    return refuse("--table and --trend have a row for each recording: leave out --together");
  if (!options.output.csv.empty()) return refuse("--csv is the curve of a single recording: use --json");
  if (!options.poses.empty()) return refuse("--poses belongs to a single recording");
  if (options.input.recording.window) return refuse("--window belongs to a single recording");
  if (options.campaign.own_offsets && options.campaign.expected)
    return refuse("--expect is about one offset: leave out --offsets each");
  return {};
}

Result<std::optional<GivenPoses>> read_poses(const EstimateArguments& options, const Recording& recording) {
  if (options.poses.empty()) return std::nullopt;
  auto poses = read_tum(options.poses, recording.epoch_ns);
  if (!poses) return tl::unexpected(poses.error());
  return GivenPoses{options.poses, std::move(*poses), options.trust_poses};
}

std::vector<std::filesystem::path> input_files(const EstimateArguments& options) {
  std::vector<std::filesystem::path> files = options.input.recording.input_files();
  if (!options.poses.empty()) files.emplace_back(options.poses);
  return files;
}

/// What makes no sense for several recordings, which share one table.
Result<void> check_campaign(const EstimateArguments& options) {
  const auto refuse = [](const char* option, const char* instead) {
    return failure(
        ExitCode::kWrongUsage,
        fmt::format("{} belongs to a single recording without --table and --trend{}", option, instead));
  };
  if (!options.output.json.empty() || !options.output.csv.empty())
    return refuse(options.output.json.empty() ? "--csv" : "--json",
                  ": use --table OUT.csv, .md, .json or .xml");
  if (keeps(options)) return refuse(options.shard ? "--shard" : "--resume", "");
  if (!options.poses.empty()) return refuse("--poses", "");
  if (!options.rig_out.empty()) return refuse("--rig-out", "");
  return {};
}

Result<std::vector<RecordingFile>> open_all(const EstimateArguments& options, const Job& job) {
  std::vector<RecordingFile> files;
  for (const std::filesystem::path& path : options.campaign.recordings) {
    RecordingOptions reading = options.input.recording;
    reading.recording = path;
    auto file = reading.open(job);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
  }
  return files;
}

ExitCode run_together(const EstimateArguments& options) {
  std::vector<std::filesystem::path> inputs;
  for (const std::filesystem::path& path : options.campaign.recordings) {
    RecordingOptions reading = options.input.recording;
    reading.recording = path;
    for (const std::filesystem::path& file : reading.input_files()) inputs.push_back(file);
  }
  if (const auto checked = options.output.check(inputs, {options.rig_out}); !checked)
    return fail(checked.error());
  EstimateOptions estimate_options = options.input.estimate;
  estimate_options.assume = options.input.recording.assumed_kind();
  Result<Estimate> found;
  {
    const Progress progress;
    const auto files = open_all(options, progress.job());
    if (!files) return fail(files.error());
    found = estimate_together({files->begin(), files->end()}, estimate_options, options.campaign.own_offsets,
                              progress.job());
  }
  return found ? conclude_search(options, *found, nullptr, "") : fail(found.error());
}

ExitCode run_single(const EstimateArguments& options, std::vector<std::string> deciding) {
  const std::string path = options.resume.empty() && options.shard ? shard_file(options) : options.resume;
  if (const auto checked = options.output.check(input_files(options), {path, options.rig_out}); !checked)
    return fail(checked.error());
  EstimateOptions estimate_options = options.input.estimate;
  estimate_options.assume = options.input.recording.assumed_kind();
  std::unique_ptr<CandidateFile> candidates;
  Result<Estimate> found;
  {
    const Progress progress;
    const auto file = options.input.recording.open(progress.job());
    if (!file) return fail(file.error());
    auto poses = read_poses(options, file->outline());
    if (!poses) return fail(poses.error());
    estimate_options.poses = std::move(*poses);
    if (!path.empty()) {
      auto opened = open_candidates(options, path, std::move(deciding));
      if (!opened) return fail(opened.error());
      candidates = std::move(*opened);
    }
    found = estimate(*file, estimate_options, {candidates.get(), options.shard}, progress.job());
  }
  if (!found) return fail(found.error());
  return conclude_search(options, *found, candidates.get(), path);
}

ExitCode run(EstimateArguments& options, std::vector<std::string> deciding) {
  const auto threads = options.input.recording.limit_threads();
  const bool campaign = options.campaign.is_campaign();
  const auto checked = check_options(options).and_then([&] {
    return campaign                    ? check_campaign(options)
           : options.campaign.together ? check_together(options)
                                       : Result<void>();
  });
  if (!checked) return fail(checked.error());
  if (options.campaign.together) return run_together(options);
  if (campaign) return run_campaign(options.campaign, options.input, deciding);
  options.input.recording.recording = options.campaign.recordings.front();
  return run_single(options, std::move(deciding));
}

constexpr const char* kPaperGroup = "The paper's methods";

void declare_poses(CLI::App& command, EstimateArguments& options) {
  command
      .add_option(
          "--poses", options.poses,
          "Trajectory of a moving rig from another source (TUM, poses of the base frame), used as a prior. "
          "The time shift of its clock is estimated and reported: t_laser = t_poses + time shift")
      ->type_name("T.tum")
      ->group(kInputGroup);
  command
      .add_flag("--trust-poses", options.trust_poses,
                "Treat --poses as the truth: the offset and the time shift are the only unknowns")
      ->group(kInputGroup);
}

void declare_candidates(CLI::App& command, EstimateArguments& options) {
  command
      .add_option("--resume", options.resume,
                  "Keep finished candidates in F; those already in F are not computed again")
      ->type_name("F")
      ->group(kPaperGroup);
  command
      .add_option_function<std::string>(
          "--shard", [&options](const std::string& text) { options.shard = parse_shard(text); },
          "Compute part K of N of the candidates of --range or --around only, into the file of --resume "
          "(default: REC.K-of-N.candidates here); `merge` combines the parts")
      ->type_name("K/N")
      ->check([](const std::string& text) {
        return parse_shard(text) ? std::string() : "--shard needs K/N with K from 1 to N, not " + text;
      })
      ->group(kPaperGroup);
}

// The order of declaration is that of --help, after the options that every subcommand has.
void declare(CLI::App& command, EstimateArguments& options) {
  EstimateInput& input = options.input;
  options.campaign.declare_recordings(command);
  options.output.declare_json(command);
  input.recording.declare_reading(command);
  input.recording.declare_computing(command);
  declare_poses(command, options);
  declare_estimate_options(command, input.estimate, {"method", "search", "over-time"}, "Search");
  declare_estimate_options(command, input.estimate,
                           {"range", "around", "fit", "scoring", "weight-c", "edge-gate-m", "plane-gate-m"},
                           kPaperGroup);
  declare_candidates(command, options);
  constexpr const char* kRigGroup = "The rig beside the offset";
  declare_estimate_options(command, input.estimate, {"solve", "prior"}, kRigGroup);
  command.add_option("--rig-out", options.rig_out, "Write the rig file with what --solve found, for --rig")
      ->type_name("F")
      ->group(kRigGroup);
  options.output.declare_others(command, "Output");
  options.campaign.declare(command);
}

}  // namespace

void add_estimate(CLI::App& app, ExitCode& exit_code) {
  CLI::App* command = app.add_subcommand("estimate", "Find the offset: t_motor = t_laser + offset");
  auto options = std::make_shared<EstimateArguments>();
  options->input.recording.keep_intensities = false;
  declare(*command, *options);
  command->callback(
      [options, command, &exit_code] { exit_code = run(*options, deciding_options(*command)); });
}

}  // namespace sweepscope::app
