#include "app/campaign.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <new>
#include <stdexcept>

#include "app/estimate_recording.hpp"
#include "app/interrupt.hpp"
#include "app/say.hpp"
#include "core/campaign/campaign_table.hpp"
#include "core/campaign/run_campaign.hpp"
#include "core/io/atomic_file.hpp"
#include "core/io/content_hash.hpp"
#include "core/memory.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "render/figures/trend_picture.hpp"
#include "render/vector/vector_file.hpp"

namespace sweepscope::app {
namespace {

namespace fs = std::filesystem;

/// What is wrong with the outputs, before any work.
Result<void> check(const CampaignOptions& options, const EstimateInput& input) {
  if (!options.table.empty())
    if (const auto format = campaign_format_of(options.table); !format) return tl::unexpected(format.error());
  if (!options.trend.empty())
    if (auto checked = check_picture_path(options.trend); !checked) return checked;
  std::vector<fs::path> inputs;
  for (const fs::path& recording : options.recordings)
    for (const fs::path& file : recording_files(recording)) inputs.push_back(file);
  if (input.recording.rig) inputs.push_back(*input.recording.rig);
  std::vector<std::string> outputs{options.table, options.trend};
  if (!options.table.empty()) outputs.push_back(rows_file(options.table));
  if (auto checked = check_outputs(outputs, std::move(inputs)); !checked) return checked;
  return input.recording.read_options().map([](const auto&) {});
}

/// A hash of all that a row depends on besides its recording.
Result<std::string> settings_hash(const EstimateInput& input, const std::vector<std::string>& deciding) {
  auto program = program_content_hash();
  if (!program) return program;
  std::string text = *program + "\n" + fmt::format("{}", fmt::join(deciding, "\n"));
  if (input.recording.rig) {
    const auto rig = file_content_hash(*input.recording.rig);
    if (!rig) return rig;
    text += "\nrig " + *rig;
  }
  return content_hash(text);
}

std::vector<CampaignInput> inputs_of(const CampaignOptions& options, const std::string& settings) {
  std::vector<CampaignInput> inputs;
  for (const fs::path& recording : options.recordings) {
    const auto fingerprint = recording_fingerprint(recording);
    inputs.push_back({recording.string(),
                      fingerprint ? content_hash(recording.string() + "\n" + *fingerprint + settings) : ""});
  }
  return inputs;
}

std::vector<std::uint64_t> sizes_of(const CampaignOptions& options) {
  std::vector<std::uint64_t> sizes;
  for (const fs::path& recording : options.recordings) sizes.push_back(recording_size_bytes(recording));
  return sizes;
}

std::optional<CampaignRow> estimate_row(const fs::path& recording, const EstimateInput& input,
                                        const Job& job) {
  RecordingOptions reading = input.recording;
  reading.recording = recording;
  EstimateOptions search = input.estimate;
  search.assume = reading.assumed_kind();
  Result<DatedEstimate> found;
  try {
    found = estimate_recording(reading, search, job);
  } catch (const std::bad_alloc&) {
    found = tl::unexpected(too_little_memory(recording.string()));
  } catch (const std::length_error&) {
    found = tl::unexpected(too_little_memory(recording.string()));
  }
  if (found ? found->estimate.interrupted : found.error().code == ExitCode::kInterrupted) return std::nullopt;
  return campaign_row(recording.string(), found);
}

/// Writes the table as rows are added: each row of a short one, and with every further 64th part of a long
/// one, so that writing stays a small part of the work.
class TableWriter {
 public:
  explicit TableWriter(std::string path) : path_(std::move(path)) {}

  Result<void> add(const Campaign& campaign) {
    const std::size_t rows = campaign.rows.size();
    return rows < written_ + 1 + rows / 64 ? Result<void>() : write(campaign);
  }
  Result<void> write(const Campaign& campaign) {
    if (path_.empty()) return {};
    written_ = campaign.rows.size();
    return campaign_format_of(path_).and_then(
        [&](CampaignFormat format) { return write_file(path_, campaign_text(campaign, format)); });
  }

 private:
  std::string path_;
  std::size_t written_ = 0;
};

std::vector<KeptRow> kept_rows(const Campaign& campaign, const std::vector<CampaignInput>& inputs) {
  std::vector<KeptRow> rows;
  for (std::size_t i = 0; i < campaign.rows.size(); ++i)
    if (!inputs[i].key.empty() && campaign.rows[i].outcome != RowOutcome::kUnreadable)
      rows.push_back({inputs[i].key, campaign.rows[i]});
  return rows;
}

Error interruption_of(const Campaign& campaign, const std::string& table) {
  std::string words = fmt::format("interrupted; {} of {} recordings are finished", campaign.rows.size(),
                                  campaign.rows.size() + campaign.pending.size());
  if (!table.empty())
    words += fmt::format(" and kept in {}; the same command continues from there", rows_file(table));
  return {ExitCode::kInterrupted, words};
}

ExitCode conclude_campaign(const CampaignOptions& options, const Campaign& campaign, TableWriter& table,
                           RowFile* kept, const std::vector<CampaignInput>& inputs) {
  print("{}\n", summary_of(campaign));
  auto written = table.write(campaign);
  if (kept != nullptr)
    if (const auto ordered = kept->replace(kept_rows(campaign, inputs)); written) written = ordered;
  if (!options.trend.empty())
    if (const auto drawn = write_trend(options.trend, campaign); written) written = drawn;
  return written ? exit_code_of(campaign) : fail(written.error());
}

std::size_t threads_in_use() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace

void CampaignOptions::declare_recordings(CLI::App& command) {
  command.add_option("REC", recordings, std::string("The recording, or several: each ") + kRecordings)
      ->required();
}

void CampaignOptions::declare(CLI::App& command) {
  constexpr const char* kGroup = "Several recordings, and expected offsets";
  command
      .add_flag("--together", together,
                "The recordings are of one rig: one offset from all of them, and with --solve one rig, each "
                "recording weighted by what it determines; recordings that do not agree are refused")
      ->group(kGroup);
  command
      .add_option_function<std::string>(
          "--offsets", [this](const std::string& text) { own_offsets = text == "each"; },
          "With --together: one offset for all recordings (one, the default), or one for each of them (each), "
          "as where the rig was switched off in between")
      ->check(CLI::IsMember({"one", "each"}))
      ->needs("--together")
      ->type_name("one|each")
      ->group(kGroup);
  command
      .add_option_function<std::string>(
          "--expect",
          [this](const std::string& text) {
            const auto read = parse_expected_offset(text);
            if (!read) throw CLI::ValidationError("--expect " + read.error().message);
            expected = *read;
          },
          "The expected offset in milliseconds, such as 24+-0.5. Exit code 1 if an offset lies outside")
      ->type_name("OFFSET+-TOLERANCE")
      ->group(kGroup);
  command
      .add_option("--table", table,
                  "Write a row per recording as .csv, .md, .json or .xml (JUnit). Finished rows are kept in "
                  "OUT.rows; the same command, started again, estimates only the missing ones")
      ->type_name("OUT")
      ->group(kGroup);
  command
      .add_option(
          "--trend", trend,
          "Draw the offsets over the recordings and their dates, with the expected band, as .png, .svg "
          "or .pdf")
      ->type_name("OUT")
      ->group(kGroup);
}

std::string rows_file(const std::string& table) {
  return table + ".rows";
}

ExitCode run_campaign(const CampaignOptions& options, const EstimateInput& input,
                      const std::vector<std::string>& deciding) {
  if (const auto checked = check(options, input); !checked) return fail(checked.error());
  const auto settings = settings_hash(input, deciding);
  if (!settings) return fail(settings.error());
  const std::vector<CampaignInput> inputs = inputs_of(options, *settings);
  std::unique_ptr<RowFile> kept;
  if (!options.table.empty()) {
    auto opened = RowFile::open(rows_file(options.table));
    if (!opened) return fail(opened.error());
    kept = std::move(*opened);
  }
  TableWriter table(options.table);
  Job job;
  job.obey(interrupt_flag());
  CampaignRun run;
  run.at_once = campaign_width(sizes_of(options), threads_in_use(), available_memory_bytes());
  run.kept = kept.get();
  run.on_row = [&](const Campaign& campaign) {
    print("{}\n", line_of(campaign.rows.back(), campaign.expected));
    std::fflush(stdout);
    return table.add(campaign);
  };
  const auto work = [&](std::size_t index, const Job& whole) {
    return estimate_row(options.recordings[index], input, whole);
  };
  const CampaignEnd end = sweepscope::run_campaign(inputs, work, options.expected, run, job);
  if (!end.done) return fail(end.done.error());
  if (job.cancelled()) {
    if (!end.campaign.rows.empty())
      if (const auto written = table.write(end.campaign); !written) return fail(written.error());
    return fail(interruption_of(end.campaign, options.table));
  }
  return conclude_campaign(options, end.campaign, table, kept.get(), inputs);
}

ExitCode conclude_expectation(const ExpectedOffset& expected, const Estimate& estimate, bool on_stdout) {
  const bool holds = expected.holds(*estimate.offset_s * 1e3);
  const std::string words = fmt::format("{:.3f} ms is {} {}", *estimate.offset_s * 1e3,
                                        holds ? "within" : "outside", expected.words());
  if (on_stdout)
    print("expected {}\n", words);
  else
    say("expected {}\n", words);
  return holds ? ExitCode::kDone : ExitCode::kNotAsExpected;
}

}  // namespace sweepscope::app
