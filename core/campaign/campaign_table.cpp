#include "core/campaign/campaign_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/campaign/campaign_json.hpp"
#include "core/io/printable_text.hpp"
#include "core/results/estimate_json.hpp"

namespace sweepscope {
namespace {

TableCell cell(const std::optional<double>& number) {
  return number ? TableCell(*number) : TableCell();
}

template <typename T>
TableCell named_cell(const std::optional<T>& value) {
  return value ? TableCell(std::string(to_text(*value))) : TableCell();
}

TableCell count_cell(std::size_t count) {
  return static_cast<double>(count);
}

std::string content(const std::string& text) {
  return markup_escaped(printable_text(text));
}

std::string reasons_of(const CampaignRow& row) {
  return fmt::format("{}", fmt::join(row.reasons, "\n"));
}

std::string offset_words(const CampaignRow& row) {
  std::string words = fmt::format("offset {} ms", *row.offset_ms);
  if (row.sigma_ms) words += fmt::format(" +- {} ms (1 sigma)", *row.sigma_ms);
  return words + "; t_motor = t_laser + offset";
}

/// A test case with what stands in it.
std::string test_case(const std::string& name, const std::string& inside) {
  return fmt::format(
      "    <testcase classname=\"sweepscope.estimate\" name=\"{}\" time=\"0\">\n{}    </testcase>\n",
      markup_line(name), inside);
}

std::string test_case(const CampaignRow& row, const std::optional<ExpectedOffset>& expected) {
  std::string inside;
  if (!row.offset_ms) {
    const std::string reasons = reasons_of(row);
    inside = fmt::format("      <error type=\"{}\" message=\"{}\">{}</error>\n", outcome_word(row, expected),
                         markup_line(reasons.substr(0, reasons.find('\n'))), content(reasons));
  } else if (is_outside(row, expected)) {
    inside = fmt::format("      <failure type=\"outside\" message=\"{} ms lies outside {}\">{}</failure>\n",
                         *row.offset_ms, expected->words(), offset_words(row));
  }
  std::string out = row.offset_ms ? offset_words(row) + "\n" : "";
  for (const std::string& warning : row.warnings) out += "warning: " + warning + "\n";
  if (!out.empty()) inside += fmt::format("      <system-out>{}</system-out>\n", content(out));
  return test_case(row.recording, inside);
}

}  // namespace

Result<CampaignFormat> campaign_format_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".csv") return CampaignFormat::kCsv;
  if (extension == ".md") return CampaignFormat::kMarkdown;
  if (extension == ".json") return CampaignFormat::kJson;
  if (extension == ".xml") return CampaignFormat::kJunit;
  return failure(
      ExitCode::kWrongUsage,
      fmt::format("{}: a table of recordings is written as .csv, .md, .json or .xml (JUnit)", path.string()));
}

Table campaign_table(const Campaign& campaign) {
  Table table;
  if (campaign.expected) table.title = "Expected: " + campaign.expected->words();
  table.columns = {{"recording", "", Alignment::kLeft, {}}, {"outcome", "", Alignment::kLeft, {}},
                   {"offset", "ms", Alignment::kRight, 3},  {"sigma", "ms", Alignment::kRight, 3},
                   {"recorded", "", Alignment::kLeft, {}},  {"kind", "", Alignment::kLeft, {}},
                   {"method", "", Alignment::kLeft, {}},    {"sweeps", "", Alignment::kRight, 0},
                   {"scans", "", Alignment::kRight, 0},     {"warnings", "", Alignment::kRight, 0},
                   {"reason", "", Alignment::kLeft, {}}};
  for (const CampaignRow& row : campaign.rows)
    table.rows.push_back(
        {row.recording, std::string(outcome_word(row, campaign.expected)), cell(row.offset_ms),
         cell(row.sigma_ms), row.recorded_ns ? TableCell(date_text(*row.recorded_ns)) : TableCell(),
         named_cell(row.kind), named_cell(row.method), count_cell(row.sweeps), count_cell(row.scans),
         count_cell(row.warnings.size()), row.reasons.empty() ? TableCell() : TableCell(reasons_of(row))});
  return table;
}

std::string campaign_to_junit(const Campaign& campaign) {
  const CampaignCounts counts = counts_of(campaign);
  const std::string expected = campaign.expected ? campaign.expected->words() : "any";
  const std::string attributes = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"0\"",
                                             campaign.rows.size() + campaign.pending.size(), counts.outside,
                                             counts.refused + counts.unusable + counts.unreadable);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format("<testsuites name=\"sweepscope estimate\" {}>\n", attributes);
  // Jenkins' schema has `skipped` here only.
  text += fmt::format("  <testsuite name=\"offset: {}\" {} skipped=\"{}\">\n", expected, attributes,
                      campaign.pending.size());
  for (const CampaignRow& row : campaign.rows) text += test_case(row, campaign.expected);
  for (const std::string& name : campaign.pending)
    text += test_case(name, "      <skipped message=\"not estimated yet\"/>\n");
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string campaign_text(const Campaign& campaign, CampaignFormat format) {
  switch (format) {
    case CampaignFormat::kCsv:
      return to_csv(campaign_table(campaign));
    case CampaignFormat::kMarkdown:
      return to_markdown(campaign_table(campaign)) + "\n" + summary_of(campaign) + "\n";
    case CampaignFormat::kJson:
      return campaign_to_json(campaign);
    case CampaignFormat::kJunit:
      break;
  }
  return campaign_to_junit(campaign);
}

}  // namespace sweepscope
