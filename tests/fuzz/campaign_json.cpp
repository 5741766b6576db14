// Tables of campaigns as JSON: what was read is written and read again as the same, in every format.
#include "core/campaign/campaign_json.hpp"

#include "core/campaign/campaign_table.hpp"
#include "tests/fuzz/memory_file.hpp"

int fuzz_campaign_json(const std::uint8_t* bytes, std::size_t size) {
  using namespace sweepscope;
  const auto campaign = parse_campaign_json(test::text_of(bytes, size), "f");
  test::expect_sentence(campaign);
  if (!campaign) return 0;
  const std::string json = campaign_to_json(*campaign);
  const auto again = parse_campaign_json(json, "again");
  if (!again || campaign_to_json(*again) != json) __builtin_trap();
  for (const auto format : {CampaignFormat::kCsv, CampaignFormat::kMarkdown, CampaignFormat::kJunit})
    if (campaign_text(*campaign, format).empty()) __builtin_trap();
  return 0;
}
