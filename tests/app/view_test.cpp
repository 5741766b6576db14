// The explorer's command line, through the shipped executable.
#include <gtest/gtest.h>

#include "core/io/atomic_file.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

class View : public test::ProgramTest {
 protected:
  void SetUp() override { ASSERT_EQ(run("simulate room-3 -o room.bag --duration-s 5").exit_code, 0); }
};

TEST_F(View, AWindowInTimeIsUsedAsByTheOtherCommands) {
  const Outcome part = run(
      "view room.bag --window 0:3 --headless --run 'wait loaded; copy-command; expect message contains --window 0:3; "
      "save-session s.json'");
  EXPECT_EQ(part.exit_code, 0) << part.err;
  const Outcome info = run("info room.bag --window 0:3");
  EXPECT_EQ(info.exit_code, 0);
  const Outcome beyond = run("view room.bag --window 100:200 --headless --run 'wait loaded'");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_NE(beyond.err.find("no scan lies within --window 100:200"), std::string::npos) << beyond.err;
  const Outcome backwards = run("view room.bag --window 3:1 --headless --run 'wait loaded'");
  EXPECT_EQ(backwards.exit_code, 2) << backwards.err;
}

TEST_F(View, AScriptsCommandsWaitForTheRecordingThatTheyNeed) {
  const Outcome estimated = run(
      "view --headless --run 'open room.bag; method direct; estimate; take-found; expect offset-b near 24 0.5; "
      "export-curve curve.csv; export-cloud b map.pcd'");
  EXPECT_EQ(estimated.exit_code, 0) << estimated.err;
  EXPECT_NE(test::contents_of(folder_ / "curve.csv"), "");
  EXPECT_NE(test::contents_of(folder_ / "map.pcd"), "");
}

TEST_F(View, ACommandForARecordingThatCannotBeReadGivesItsReason) {
  const Outcome failed = run("view --headless --run 'open missing.bag; estimate'");
  EXPECT_EQ(failed.exit_code, 3) << failed.err;
  EXPECT_NE(failed.err.find("missing.bag"), std::string::npos) << failed.err;
  const Outcome none = run("view --headless --run 'estimate'");
  EXPECT_EQ(none.exit_code, 2) << none.err;
}

TEST_F(View, WhatIsRecordedReplacesNoInput) {
  const std::string before = read_file(folder_ / "room.bag").value();
  const Outcome recorded = run("view room.bag --record room.bag");
  EXPECT_EQ(recorded.exit_code, 2);
  EXPECT_NE(recorded.err.find("room.bag"), std::string::npos) << recorded.err;
  EXPECT_EQ(read_file(folder_ / "room.bag").value(), before);
}

TEST_F(View, WithoutADisplayTheOtherWaysAreNamed) {
  const Outcome refused = run("view room.bag", "-u DISPLAY -u WAYLAND_DISPLAY");
  EXPECT_EQ(refused.exit_code, 2);
  for (const char* way : {"--headless", "sweepscope report", "sweepscope compare"})
    EXPECT_NE(refused.err.find(way), std::string::npos) << refused.err;
}

TEST_F(View, AMisspeltNameIsAnsweredWithTheNearestOne) {
  const Outcome misspelt = run("estimte room.bag");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_EQ(misspelt.err,
            "sweepscope: there is no subcommand \"estimte\". Did you mean \"estimate\"? All subcommands: "
            "sweepscope --help\n");
  const Outcome file = run("room.bag");
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_EQ(file.err.find("Did you mean"), std::string::npos) << file.err;
  const Outcome command = run("view --headless --run 'ofset-a 3'");
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_NE(command.err.find("Did you mean \"offset-a\"?"), std::string::npos) << command.err;
}

}  // namespace
}  // namespace sweepscope
