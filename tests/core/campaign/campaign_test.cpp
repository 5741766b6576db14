#include "core/campaign/campaign.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/campaign/campaign_json.hpp"
#include "core/campaign/campaign_table.hpp"
#include "tests/core/campaign/rows.hpp"

namespace sweepscope {
namespace {

using test::answered;
using test::campaign_of;
using test::without_offset;

TEST(Campaign, TheExitCodeIsThatOfTheWorstRow) {
  const CampaignRow good = answered("a", 24), bad = answered("b", 25),
                    refused = without_offset("c", RowOutcome::kRefused),
                    unreadable = without_offset("d", RowOutcome::kUnreadable),
                    unusable = without_offset("e", RowOutcome::kUnusable);
  EXPECT_EQ(exit_code_of(campaign_of({good})), ExitCode::kDone);
  EXPECT_EQ(exit_code_of(campaign_of({good, refused})), ExitCode::kNotIdentifiable);
  EXPECT_EQ(exit_code_of(campaign_of({refused, unreadable, good})), ExitCode::kUnreadableInput);
  EXPECT_EQ(exit_code_of(campaign_of({unreadable, unusable})), ExitCode::kWrongUsage);
  EXPECT_EQ(exit_code_of(campaign_of({unreadable, refused, unusable, bad})), ExitCode::kNotAsExpected);
  Campaign anything = campaign_of({good, bad});
  anything.expected.reset();
  EXPECT_EQ(exit_code_of(anything), ExitCode::kDone);
}

TEST(Campaign, ALinePerRowSaysWhatBecameOfIt) {
  const ExpectedOffset expected{24, 0.5};
  EXPECT_EQ(line_of(answered("a.bag", 24.0131), expected),
            "a.bag: 24.013 ms +- 0.020 ms, within 24 +- 0.5 ms");
  EXPECT_EQ(line_of(answered("a.bag", 25), expected), "a.bag: 25.000 ms +- 0.020 ms, outside 24 +- 0.5 ms");
  EXPECT_EQ(line_of(answered("a.bag", 25), {}), "a.bag: 25.000 ms +- 0.020 ms");
  CampaignRow row = without_offset("x/a.bag", RowOutcome::kUnreadable);
  row.reasons = {"x/a.bag: no such file"};
  EXPECT_EQ(line_of(row, expected), "x/a.bag: unreadable: no such file");
  EXPECT_EQ(summary_of(campaign_of({answered("a", 24), answered("b", 25), row})),
            "3 recordings: 1 within 24 +- 0.5 ms, 1 outside, 1 unreadable");
}

TEST(Campaign, ADateIsKnownOnlyOfAClockThatCountsFrom1970) {
  EXPECT_EQ(recorded_ns(1'700'000'000'000'000'000, 0.5), 1'700'000'000'500'000'000);
  EXPECT_FALSE(recorded_ns(5'000'000'000, 1));
  EXPECT_EQ(date_text(1'700'000'000'250'000'000), "2023-11-14T22:13:20.250Z");
}

TEST(CampaignJson, IsReadBackToTheLastDigit) {
  Campaign campaign =
      campaign_of({answered("a", 24.000000001), answered("b", 25), without_offset("c", RowOutcome::kRefused),
                   without_offset("d", RowOutcome::kUnreadable)});
  campaign.rows[0].recorded_ns = 1'700'000'000'250'000'001;
  campaign.rows[0].warnings = {"a warning"};
  campaign.pending = {"e"};
  const std::string json = campaign_to_json(campaign);
  const auto read = parse_campaign_json(json, "t.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(campaign_to_json(*read), json);
  const auto document = nlohmann::ordered_json::parse(json);
  EXPECT_EQ(document["schema"], "sweepscope.campaign/1");
  EXPECT_EQ(document["complete"], false);
  EXPECT_EQ(document["rows"][1]["outcome"], "outside");
  EXPECT_EQ(document["rows"][0]["recorded"], "2023-11-14T22:13:20.250Z");
}

TEST(CampaignJson, AnythingElseIsRefused) {
  for (const char* text : {"", "{}", "[]", "{\"schema\": \"sweepscope.estimate/1\"}",
                           "{\"schema\": \"sweepscope.campaign/1\", \"expected\": null, \"rows\": [{}]}"}) {
    const auto read = parse_campaign_json(text, "t.json");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ExitCode::kUnreadableInput);
    EXPECT_TRUE(read.error().message.starts_with("t.json: ")) << read.error().message;
  }
}

TEST(CampaignTable, HasARowPerRecording) {
  Campaign campaign = campaign_of({answered("a,b.bag", 24.25), without_offset("c", RowOutcome::kRefused)});
  campaign.rows[1].reasons = {"The motor did not turn."};
  EXPECT_EQ(campaign_text(campaign, CampaignFormat::kCsv),
            "recording,outcome,offset_ms,sigma_ms,recorded,kind,method,sweeps,scans,warnings,reason\n"
            "\"a,b.bag\",within,24.25,0.02,,stationary,direct,9,180,0,\n"
            "c,refused,,,,,,0,0,0,The motor did not turn.\n");
  const std::string markdown = campaign_text(campaign, CampaignFormat::kMarkdown);
  EXPECT_TRUE(markdown.starts_with("**Expected: 24 +- 0.5 ms**\n\n| recording | outcome |")) << markdown;
  EXPECT_TRUE(markdown.ends_with("\n2 recordings: 1 within 24 +- 0.5 ms, 1 refused\n")) << markdown;
}

TEST(CampaignTable, AsJunitCountsFailuresErrorsAndWhatIsPending) {
  Campaign campaign =
      campaign_of({answered("a<&>\".bag", 24), answered("b", 25), without_offset("c", RowOutcome::kRefused),
                   without_offset("d", RowOutcome::kUnreadable)});
  campaign.pending = {"e"};
  const std::string xml = campaign_text(campaign, CampaignFormat::kJunit);
  EXPECT_NE(xml.find("<testsuite name=\"offset: 24 +- 0.5 ms\" tests=\"5\" failures=\"1\" errors=\"2\" "
                     "time=\"0\" skipped=\"1\">"),
            std::string::npos)
      << xml;
  EXPECT_NE(xml.find("name=\"a&lt;&amp;&gt;&quot;.bag\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<failure type=\"outside\" message=\"25 ms lies outside 24 +- 0.5 ms\">"),
            std::string::npos)
      << xml;
  EXPECT_NE(xml.find("<error type=\"refused\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<skipped message=\"not estimated yet\"/>"), std::string::npos) << xml;
}

TEST(CampaignTable, AsJunitHasOnlyTheAttributesOfJenkinssSchema) {
  Campaign campaign = campaign_of({answered("a", 24)});
  campaign.pending = {"b"};
  const std::string xml = campaign_to_junit(campaign);
  EXPECT_NE(xml.find("<testsuites name=\"sweepscope estimate\" tests=\"2\" failures=\"0\" errors=\"0\" "
                     "time=\"0\">\n"),
            std::string::npos)
      << xml;
}

TEST(CampaignTable, AnUnknownExtensionIsRefused) {
  EXPECT_EQ(campaign_format_of("t.txt").error().code, ExitCode::kWrongUsage);
  EXPECT_EQ(campaign_format_of("t").error().code, ExitCode::kWrongUsage);
}

}  // namespace
}  // namespace sweepscope
