#include "core/campaign/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

std::optional<double> to_ms(const std::optional<double>& seconds) {
  if (!seconds) return std::nullopt;
  return std::round(*seconds * 1e12) / 1e9;
}

RowOutcome outcome_of(ExitCode code) {
  if (code == ExitCode::kNotIdentifiable) return RowOutcome::kRefused;
  return code == ExitCode::kWrongUsage ? RowOutcome::kUnusable : RowOutcome::kUnreadable;
}

/// Of a reason with a list below it, the sentence.
std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

std::optional<std::int64_t> recorded_ns(std::int64_t epoch_ns, double first_scan_s) {
  constexpr std::int64_t kYear2000_ns = 946'684'800'000'000'000;
  const std::int64_t ns = epoch_ns + static_cast<std::int64_t>(std::llround(first_scan_s * 1e9));
  return ns < kYear2000_ns ? std::nullopt : std::optional(ns);
}

CampaignRow campaign_row(const std::string& recording, const Result<DatedEstimate>& found) {
  CampaignRow row;
  row.recording = recording;
  if (!found) {
    row.outcome = outcome_of(found.error().code);
    row.reasons = {found.error().message};
    return row;
  }
  const Estimate& estimate = found->estimate;
  row.recorded_ns = found->recorded_ns;
  row.outcome = estimate.identifiable ? RowOutcome::kAnswered : RowOutcome::kRefused;
  if (estimate.identifiable) {
    row.offset_ms = to_ms(estimate.offset_s);
    row.sigma_ms = to_ms(estimate.sigma_s);
  }
  row.method = estimate.method;
  row.kind = estimate.kind;
  row.sweeps = estimate.sweeps;
  row.scans = estimate.scans;
  row.warnings = estimate.warnings;
  row.reasons = estimate.reasons();
  return row;
}

bool is_outside(const CampaignRow& row, const std::optional<ExpectedOffset>& expected) {
  return expected && row.offset_ms && !expected->holds(*row.offset_ms);
}

const char* outcome_word(const CampaignRow& row, const std::optional<ExpectedOffset>& expected) {
  if (row.outcome == RowOutcome::kRefused) return "refused";
  if (row.outcome == RowOutcome::kUnusable) return "unusable";
  if (row.outcome == RowOutcome::kUnreadable) return "unreadable";
  if (!expected) return "answered";
  return is_outside(row, expected) ? "outside" : "within";
}

CampaignCounts counts_of(const Campaign& campaign) {
  CampaignCounts counts;
  for (const CampaignRow& row : campaign.rows) {
    if (row.outcome == RowOutcome::kRefused)
      ++counts.refused;
    else if (row.outcome == RowOutcome::kUnusable)
      ++counts.unusable;
    else if (row.outcome == RowOutcome::kUnreadable)
      ++counts.unreadable;
    else if (!campaign.expected)
      ++counts.answered;
    else
      ++(is_outside(row, campaign.expected) ? counts.outside : counts.within);
  }
  return counts;
}

ExitCode exit_code_of(const Campaign& campaign) {
  const CampaignCounts counts = counts_of(campaign);
  if (counts.outside > 0) return ExitCode::kNotAsExpected;
  if (counts.unusable > 0) return ExitCode::kWrongUsage;
  if (counts.unreadable > 0) return ExitCode::kUnreadableInput;
  return counts.refused > 0 ? ExitCode::kNotIdentifiable : ExitCode::kDone;
}

std::string line_of(const CampaignRow& row, const std::optional<ExpectedOffset>& expected) {
  if (!row.offset_ms) {
    std::string why = row.reasons.empty() ? "" : first_line(row.reasons.front());
    // Errors of reading begin with the name of the file themselves.
    if (why.starts_with(row.recording + ": ")) why.erase(0, row.recording.size() + 2);
    return fmt::format("{}: {}: {}", row.recording, outcome_word(row, expected), why);
  }
  std::string line = fmt::format("{}: {:.3f} ms", row.recording, *row.offset_ms);
  if (row.sigma_ms) line += fmt::format(" +- {:.3f} ms", *row.sigma_ms);
  if (expected) line += fmt::format(", {} {}", outcome_word(row, expected), expected->words());
  return line;
}

std::string summary_of(const Campaign& campaign) {
  const CampaignCounts counts = counts_of(campaign);
  std::string parts;
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count > 0) parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", count, what);
  };
  if (campaign.expected) add(counts.within, "within " + campaign.expected->words());
  if (campaign.expected)
    add(counts.outside, counts.within > 0 ? "outside" : "outside " + campaign.expected->words());
  add(counts.answered, "with an offset");
  add(counts.refused, "refused");
  add(counts.unusable, "unusable with these options");
  add(counts.unreadable, "unreadable");
  const std::size_t count = campaign.rows.size();
  return fmt::format("{} recording{}: {}", count, count == 1 ? "" : "s", parts);
}

}  // namespace sweepscope
