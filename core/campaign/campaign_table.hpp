#pragma once

#include <filesystem>
#include <string>

#include "core/campaign/campaign.hpp"
#include "core/io/table.hpp"

namespace sweepscope {

/// A table's file format, by the extension of its name.
enum class CampaignFormat { kCsv, kMarkdown, kJson, kJunit };

/// .csv, .md, .json or .xml (JUnit); another extension is ExitCode::kWrongUsage.
Result<CampaignFormat> campaign_format_of(const std::filesystem::path& path);

/// A row per recording: recording, outcome, offset and sigma in ms, when it was recorded, kind, method,
/// sweeps, scans, how many warnings there are, and the reason where there is no offset.
Table campaign_table(const Campaign& campaign);

/// A test suite as JUnit writes it: a test case per recording, with a failure where the offset lies outside,
/// an error where there is no offset, and skipped where an interrupted run has no row yet. All times are 0,
/// so that equal runs give equal bytes.
std::string campaign_to_junit(const Campaign& campaign);

/// The bytes of the file.
std::string campaign_text(const Campaign& campaign, CampaignFormat format);

}  // namespace sweepscope
