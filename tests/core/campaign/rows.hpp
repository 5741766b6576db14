#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.hpp"

/// Rows of campaigns that nothing had to be estimated for.
namespace sweepscope::test {

inline CampaignRow answered(const std::string& recording, double offset_ms) {
  CampaignRow row;
  row.recording = recording;
  row.outcome = RowOutcome::kAnswered;
  row.offset_ms = offset_ms;
  row.sigma_ms = 0.02;
  row.method = Method::kDirect;
  row.kind = RigKind::kStationary;
  row.sweeps = 9;
  row.scans = 180;
  return row;
}

inline CampaignRow without_offset(const std::string& recording, RowOutcome outcome) {
  CampaignRow row;
  row.recording = recording;
  row.outcome = outcome;
  row.reasons = {recording + ": a reason"};
  return row;
}

inline Campaign campaign_of(std::vector<CampaignRow> rows) {
  return {ExpectedOffset{24, 0.5}, std::move(rows), {}};
}

}  // namespace sweepscope::test
