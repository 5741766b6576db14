// What the program says of itself: the overview, and the order of the options of --help and of the manual
// page.
#include <gtest/gtest.h>

#include <string_view>

#include "tests/program.hpp"

namespace sweepscope::test {
namespace {

using Help = ProgramTest;

/// The texts stand in this order.
void expect_in_order(const std::string& text, std::initializer_list<std::string_view> parts) {
  std::size_t at = 0;
  for (const std::string_view part : parts) {
    const std::size_t found = text.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << " is not there, or not in its place, in:\n" << text;
    at = found + part.size();
  }
}

TEST_F(Help, TheProgramAlonePrintsTheOverviewWithAnExamplePerTask) {
  const Outcome alone = run("");
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_EQ(alone.err, "");
  for (const char* command : {"estimate", "compare", "view", "figures", "apply", "simulate"})
    EXPECT_NE(alone.out.find(std::string("sweepscope ") + command + " "), std::string::npos) << command;
  EXPECT_EQ(alone.out, run("--help").out);
}

TEST_F(Help, OptionsOfEstimateHaveHeadingsWithTheCommonOnesFirst) {
  const Outcome help = run("estimate --help");
  EXPECT_EQ(help.exit_code, 0);
  expect_in_order(help.out, {"\nOptions:",
                             "--help",
                             "--json",
                             "--rig",
                             "--window",
                             "--threads",
                             "\nInput:",
                             "--laser",
                             "--stamps",
                             "--assume",
                             "--poses",
                             "\nSearch:",
                             "--method",
                             "--over-time",
                             "\nThe paper's methods:",
                             "--fit",
                             "--range",
                             "--shard",
                             "\nThe rig beside the offset:",
                             "--solve",
                             "--rig-out",
                             "\nOutput:",
                             "--csv",
                             "\nSeveral recordings",
                             "--together",
                             "--expect",
                             "--table"});
}

TEST_F(Help, TheManualPageHasTheSameHeadings) {
  const std::string page = run("--man").out;
  expect_in_order(page,
                  {".SS sweepscope estimate", "\\-\\-json", "\\fBInput\\fR", "\\-\\-laser",
                   "\\fBThe paper's methods\\fR", "\\-\\-range", ".SS sweepscope calibrate", ".SH EXAMPLES"});
}

}  // namespace
}  // namespace sweepscope::test
