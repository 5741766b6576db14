// The explorer's command line, through the shipped executable.
#include <gtest/gtest.h>

#include <csignal>

#include "core/io/atomic_file.hpp"
#include "tests/app/self_signal.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

class View : public test::ProgramTest {
 protected:
  void SetUp() override { make({"simulate room-3 -o room.bag --duration-s 5"}); }
  /// Width and height as the file's header says.
  std::pair<int, int> size_of_png(const std::string& name) const {
    const std::string bytes = test::contents_of(folder_ / name);
    const auto number = [&](std::size_t at) {
      int value = 0;
      for (std::size_t i = at; i < at + 4; ++i)
        value = 256 * value + static_cast<unsigned char>(bytes.size() > i ? bytes[i] : '\0');
      return value;
    };
    return {number(16), number(20)};
  }
  /// Of a recording whose maps are solved.
  void expect_wrong(const std::string& line) const {
    const Outcome refused = run("view room.bag --headless --no-estimate --run 'wait solved; " + line + "'");
    EXPECT_EQ(refused.exit_code, 2) << line << refused.err;
  }
};

TEST_F(View, AWindowInTimeIsUsedAsByTheOtherCommands) {
  const Outcome part = run(
      "view room.bag --window 0:3 --headless --no-estimate --run 'wait loaded; copy-command; expect message contains "
      "--window 0:3; "
      "save-session s.json'");
  EXPECT_EQ(part.exit_code, 0) << part.err;
  const Outcome info = run("info room.bag --window 0:3");
  EXPECT_EQ(info.exit_code, 0);
  const Outcome beyond = run("view room.bag --window 100:200 --headless --run 'wait loaded'");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_NE(beyond.err.find("no scan lies between 100 and 200 s"), std::string::npos) << beyond.err;
  const Outcome backwards = run("view room.bag --window 3:1 --headless --run 'wait loaded'");
  EXPECT_EQ(backwards.exit_code, 2) << backwards.err;
}

TEST_F(View, AScriptsCommandsWaitForTheRecordingThatTheyNeed) {
  const Outcome estimated =
      run("view --headless --run 'open room.bag; method direct; estimate; take-found; expect offset-b near "
          "24 0.5; "
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

TEST_F(View, TheMapsAreExportedAtASizeOfTheirOwn) {
  const Outcome exported = run(
      "view room.bag --headless --no-estimate --size 1000x600 --run 'wait solved; export-picture all.png; "
      "export-picture maps.png maps; export-picture sized.png maps 1600x900; theme light; "
      "export-picture light.png maps 1600x900'");
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  const auto all = size_of_png("all.png"), maps = size_of_png("maps.png");
  EXPECT_EQ(all, std::pair(1000, 600));
  EXPECT_LT(maps.first, all.first);
  EXPECT_EQ(size_of_png("sized.png"), std::pair(1600, 900));
  EXPECT_EQ(size_of_png("light.png"), std::pair(1600, 900));
  EXPECT_NE(test::contents_of(folder_ / "sized.png"), test::contents_of(folder_ / "light.png"));
  for (const char* size : {"1600", "1600x", "axb", "0x900", "1600x900x2", "99999x99999"}) {
    expect_wrong(std::string("export-picture no.png maps ") + size);
    EXPECT_FALSE(exists("no.png")) << size;
  }
  expect_wrong("export-picture no.png everything 1600x900");
}

TEST_F(View, AFigureIsWrittenAsPngSvgOrPdfWithTheChosenParts) {
  const Outcome exported =
      run("view room.bag --headless --no-estimate --size 800x600 --run 'offset-b 24; wait solved; "
          "export-figure all.png; export-figure all.svg 1600x1000; export-figure bare.svg 1600x1000 none; "
          "export-figure all.pdf 1600x1000 offsets,legend'");
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_EQ(size_of_png("all.png"), std::pair(1920, 1200));
  const std::string all = test::contents_of(folder_ / "all.svg"),
                    bare = test::contents_of(folder_ / "bare.svg");
  for (const char* words : {"offset 24.0 ms", ">elevation<"}) {
    EXPECT_NE(all.find(words), std::string::npos) << words;
    EXPECT_EQ(bare.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(test::contents_of(folder_ / "all.pdf").substr(0, 5), "%PDF-");
  expect_wrong("export-figure no.jpg");
  expect_wrong("export-figure no.png 1600x1000 legend,title");
}

TEST_F(View, WhatIsRecordedReplacesNoInput) {
  const std::string before = read_file(folder_ / "room.bag").value();
  const Outcome recorded = run("view room.bag --record room.bag");
  EXPECT_EQ(recorded.exit_code, 2);
  EXPECT_NE(recorded.err.find("room.bag"), std::string::npos) << recorded.err;
  EXPECT_EQ(read_file(folder_ / "room.bag").value(), before);
}

TEST_F(View, AServerThatOthersReachMustBeAskedFor) {
  for (const char* address : {"0.0.0.0:0", "[::]:0", "192.0.2.1"}) {
    const Outcome refused = run(std::string("view room.bag --serve ") + address);
    EXPECT_EQ(refused.exit_code, 2) << address;
    EXPECT_NE(refused.err.find("--listen-anywhere"), std::string::npos) << refused.err;
  }
  for (const char* wrong : {"--serve room.bag", "--serve 127.0.0.1:99999", "--serve --root none", "--root .",
                            "--once", "--serve --headless", "--serve 192.0.2.1 --listen-anywhere"})
    EXPECT_EQ(run(std::string("view ") + wrong).exit_code, 2) << wrong;
}

TEST_F(View, AServerIsInterrupted) {
  const Outcome served =
      run("view room.bag --serve 127.0.0.1:0", test::SelfSignal{SIGINT, "Ctrl-C ends it", 1}.environment());
  EXPECT_EQ(served.exit_code, 130) << served.err;
  EXPECT_NE(served.out.find("#token="), std::string::npos) << served.out;
  EXPECT_NE(served.out.find("ssh -N -L "), std::string::npos) << served.out;
}

TEST_F(View, ARecordingMayFollowTheFoldersAndNamesOfAServer) {
  for (const char* options : {"--root .", "--root . --root .", "--host a.example --host b.example"}) {
    const test::SelfSignal when_served{SIGINT, "Ctrl-C ends it", 1};
    // A trajectory requires a recording, which the option before it must not have taken.
    const Outcome served =
        run(std::string("view --serve 127.0.0.1:0 ") + options + " room.bag --poses room.truth.tum",
            when_served.environment());
    EXPECT_EQ(served.exit_code, 130) << options << ": " << served.err;
  }
}

TEST_F(View, WithoutADisplayTheOtherWaysAreNamed) {
  const Outcome refused = run("view room.bag", "-u DISPLAY -u WAYLAND_DISPLAY");
  EXPECT_EQ(refused.exit_code, 2);
  for (const char* way : {"--serve", "--headless", "sweepscope report", "sweepscope compare"})
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
