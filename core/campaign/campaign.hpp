#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/expected_offset.hpp"
#include "core/error.hpp"
#include "core/offset/estimate.hpp"

/// The offsets of many recordings, and whether they are as expected.
namespace sweepscope {

/// What became of one recording.
enum class RowOutcome {
  kAnswered,
  kRefused,     // the recording does not determine the offset
  kUnusable,    // the options cannot be used with this recording, such as a range wider than its motor allows
  kUnreadable,  // the file cannot be read
};

/// An estimate, and when its recording was made.
struct DatedEstimate {
  Estimate estimate;
  std::optional<std::int64_t> recorded_ns;  // the first scan, since 1970; see recorded_ns()
};

/// One recording of a campaign. It holds no time of computing, so that equal runs give equal rows.
struct CampaignRow {
  std::string recording;                    // as it was named
  std::optional<std::int64_t> recorded_ns;  // the first scan, since 1970
  RowOutcome outcome = RowOutcome::kUnreadable;
  std::optional<double> offset_ms, sigma_ms;  // to 1e-9 ms
  std::optional<Method> method;
  std::optional<RigKind> kind;
  std::size_t sweeps = 0, scans = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> reasons;  // why there is no offset
};

struct Campaign {
  std::optional<ExpectedOffset> expected;
  std::vector<CampaignRow> rows;     // in the order in which the recordings were named
  std::vector<std::string> pending;  // recordings of an unfinished campaign that have no row yet
};

/// The time of a recording's first scan, or nothing where its clock does not count from 1970: before 2000.
std::optional<std::int64_t> recorded_ns(std::int64_t epoch_ns, double first_scan_s);

/// The row of a recording that was read and estimated, or of the error that prevented it.
CampaignRow campaign_row(const std::string& recording, const Result<DatedEstimate>& found);

/// Whether the offset was found and is not as expected.
bool is_outside(const CampaignRow& row, const std::optional<ExpectedOffset>& expected);

/// "within", "outside", "answered" (nothing is expected), "refused", "unusable" or "unreadable".
const char* outcome_word(const CampaignRow& row, const std::optional<ExpectedOffset>& expected);

/// How many rows have each outcome.
struct CampaignCounts {
  std::size_t within = 0, outside = 0, answered = 0, refused = 0, unusable = 0, unreadable = 0;
};
CampaignCounts counts_of(const Campaign& campaign);

/// kNotAsExpected if any offset lies outside; otherwise that of the worst row: kWrongUsage, kUnreadableInput,
/// kNotIdentifiable, in this order; kDone if every recording has an offset.
ExitCode exit_code_of(const Campaign& campaign);

/// "walk-01.bag: 24.013 ms +- 0.021 ms, within 24 +- 0.5 ms", or the reason why there is no offset.
std::string line_of(const CampaignRow& row, const std::optional<ExpectedOffset>& expected);
/// "20 recordings: 17 within 24 +- 0.5 ms, 1 outside, 2 refused".
std::string summary_of(const Campaign& campaign);

}  // namespace sweepscope
