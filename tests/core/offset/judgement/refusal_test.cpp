#include "core/offset/judgement/refusal.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace sweepscope {
namespace {

/// Section 14 of docs/algorithms.md.
std::string documented() {
  std::ifstream file(SWEEPSCOPE_SOURCE_DIR "/docs/algorithms.md");
  std::stringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  const auto begin = text.find("## 14. Refusals");
  EXPECT_NE(begin, std::string::npos);
  return text.substr(begin, text.find("## 15.") - begin);
}

std::string row_of(const std::string& section, const std::string& code) {
  const auto at = section.find("| `" + code + "` |");
  return at == std::string::npos ? "" : section.substr(at, section.find('\n', at) - at);
}

TEST(Refusals, AreDocumentedWithTheirLimits) {
  const std::string section = documented();
  for (const RefusalEntry& entry : refusal_entries()) {
    const std::string row = row_of(section, entry.code);
    const std::string limit = entry.limit ? fmt::format("| {:g} {} |", *entry.limit, entry.unit) : "| |";
    EXPECT_TRUE(row.ends_with(limit)) << entry.code << " must have " << limit << " in section 14: " << row;
  }
}

TEST(Refusals, AllThatAreDocumentedExist) {
  std::istringstream lines(documented());
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find("| `"), end = line.find("` |");
    if (begin == std::string::npos) continue;
    const std::string code = line.substr(begin + 3, end - begin - 3);
    ++rows;
    EXPECT_STREQ(entry_of(refusal_kind_of(code)).code, code.c_str());
  }
  EXPECT_EQ(rows, refusal_entries().size());
}

TEST(Refusals, HaveCodesThatNameOneEach) {
  std::set<std::string> codes;
  for (const RefusalEntry& entry : refusal_entries()) {
    EXPECT_TRUE(codes.insert(entry.code).second) << entry.code;
    EXPECT_EQ(refusal_kind_of(entry.code), entry.kind);
  }
  EXPECT_EQ(refusal_kind_of("of no version"), RefusalKind::kUnknown);
}

TEST(Refusals, HoldWhatWasMeasuredAndTheLimit) {
  const Refusal few = refusal(RefusalKind::kFewMotorSamples, 2.0, 2);
  EXPECT_EQ(few.text, "The motor has only 2 samples.");
  EXPECT_EQ(few.value, 2);
  EXPECT_EQ(few.limit, 3);
  EXPECT_EQ(refusal(RefusalKind::kSigmaUnknown, {}).limit, std::nullopt);
}

}  // namespace
}  // namespace sweepscope
