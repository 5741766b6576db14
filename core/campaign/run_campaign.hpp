#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/campaign/campaign.hpp"
#include "core/campaign/row_file.hpp"
#include "core/error.hpp"
#include "core/job.hpp"

namespace sweepscope {

/// A recording of a campaign.
struct CampaignInput {
  std::string recording;  // as it was named
  std::string key;        // hash of everything that its row depends on; empty: its row is not kept
};

/// Estimates the recording of that index; nothing if the job was cancelled. Called from several threads.
using EstimateRow = std::function<std::optional<CampaignRow>(std::size_t index, const Job& job)>;

struct CampaignRun {
  std::size_t at_once = 1;  // recordings that are worked on at the same time
  RowFile* kept = nullptr;  // rows that are there are not estimated again; null: none
  /// Called with the rows in the order of the recordings, as soon as all before are finished; on one thread
  /// at a time. The row is the campaign's last one.
  std::function<Result<void>(const Campaign&)> on_row;
};

/// Estimates the recordings, several at once. The result is the same for any number of threads. A cancelled
/// campaign, or one whose row could not be written, holds the rows that were finished and names the others in
/// `pending`; only the latter is an error. Recordings that could not be read are not kept: what hindered may
/// be gone in the next run, with the file unchanged.
struct CampaignEnd {
  Campaign campaign;
  Result<void> done;
};
CampaignEnd run_campaign(std::span<const CampaignInput> inputs, const EstimateRow& estimate_row,
                         const std::optional<ExpectedOffset>& expected, const CampaignRun& run,
                         const Job& job);

/// How many recordings may be worked on at once: as many as there are threads, or fewer so that the largest
/// that many of them fit into half of the memory that is available; at least 1.
std::size_t campaign_width(std::vector<std::uint64_t> recording_bytes, std::size_t threads,
                           std::optional<std::uint64_t> available_bytes);

}  // namespace sweepscope
