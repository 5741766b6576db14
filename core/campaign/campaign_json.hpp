#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/campaign/campaign.hpp"

namespace sweepscope {

/// A row as it is kept in files: everything that was found, whatever is expected.
nlohmann::ordered_json row_to_json(const CampaignRow& row);
/// Reads what row_to_json made. Throws std::exception for anything else.
CampaignRow row_from_json(const nlohmann::ordered_json& json);

/// A campaign as a JSON object (schema "sweepscope.campaign/1"): what is expected, the counts, and per row
/// the outcome beside what row_to_json gives. "complete" is false while recordings have no row.
std::string campaign_to_json(const Campaign& campaign);

/// Reads what campaign_to_json wrote. `name` is the name of the file in error messages.
Result<Campaign> parse_campaign_json(std::string_view text, std::string_view name);

/// When a recording was made: "2026-11-23T14:05:06.250Z".
std::string date_text(std::int64_t recorded_ns);

}  // namespace sweepscope
