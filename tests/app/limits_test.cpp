// What the program does where the machine gives it too little: memory, threads, libraries; and what a killed
// run leaves.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/app/self_signal.hpp"
#include "tests/core/recording/zstd_bytes.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

class Limits : public test::ProgramTest {
 protected:
  /// Run by a shell after `before`, such as "ulimit -v 100".
  Outcome run_after(const std::string& before, const std::string& arguments) const {
    return test::run_shell(
        folder_, "bash -c \"" + before + " && exec '" SWEEPSCOPE_EXECUTABLE "' " + arguments + "\"");
  }
  static bool can_run(const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
  }
};

TEST_F(Limits, TooLittleMemoryNamesTheFile) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take more address space than any limit leaves";
#endif
  make({"simulate metro-station -o walk.bag --duration-s 20"});
  const char* const commands[] = {"map walk.bag --offset-ms 24 -o map.pcd --threads 1", "info walk.bag"};
  constexpr int kFirst_kB = 100'000, kStep_kB = 10'000, kLast_kB = 2'000'000;
  bool too_little = false, enough = false;
  for (int max_kB = kFirst_kB; !enough && max_kB <= kLast_kB; max_kB += kStep_kB) {
    const std::string limit = "ulimit -v " + std::to_string(max_kB);
    // The libraries alone take much.
    if (run_after(limit, "--version").exit_code != 0) continue;
    enough = true;
    for (const char* command : commands) {
      const Outcome outcome = run_after(limit, command);
      if (outcome.exit_code == 0) continue;
      too_little = true;
      enough = false;
      EXPECT_EQ(outcome.exit_code, 3) << limit << ": " << command << ": " << outcome.err;
      const std::string sentence = "sweepscope: walk.bag: needs more memory than this machine has\n";
      EXPECT_TRUE(outcome.err.ends_with(sentence)) << limit << ": " << outcome.err;
      const std::string before = outcome.err.substr(0, outcome.err.size() - sentence.size());
      EXPECT_TRUE(before.empty() || before.starts_with("warning: walk.bag: its map needs about")) << before;
      for (const auto& entry : std::filesystem::directory_iterator(folder_))
        EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }
  EXPECT_TRUE(enough);
  EXPECT_TRUE(too_little) << "no limit was too little";
}

TEST_F(Limits, FewerThreadsThanProcessorsGiveTheSameResult) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers start processes of their own";
#endif
  if (geteuid() != 0 || !can_run("setpriv --reuid=54321 --clear-groups true"))
    GTEST_SKIP() << "a limit of processes wants a user who has none: root, and setpriv";
  make({"simulate room-2 -o room.bag"});
  for (const fs::path& path : {folder_, folder_ / "room.bag"}) chmod(path.c_str(), 0777);
  const auto as_limited = [&](int processes, const std::string& arguments) {
    // Root has no limit, and another user has no other processes. What it says is written by root's shell.
    return test::run_shell(
        folder_,
        "timeout -s KILL 120 setpriv --reuid=54321 --regid=54321 --clear-groups bash -c 'ulimit -u " +
            std::to_string(processes) + " && exec \"$0\" \"$@\"' '" SWEEPSCOPE_EXECUTABLE "' " + arguments);
  };
  const std::string estimate = "estimate room.bag --json - --no-timing --threads 8";
  const Outcome free = run(estimate);
  ASSERT_EQ(free.exit_code, 0) << free.err;
  bool refused = false, worked = false;
  for (const int processes : {1, 2, 3, 4, 6}) {
    const Outcome outcome = as_limited(processes, estimate);
    if (outcome.exit_code == 2) {
      refused = true;
      EXPECT_FALSE(worked) << "with fewer it did";
      EXPECT_EQ(outcome.err,
                "sweepscope: no thread can be started; raise the limit of processes (ulimit -u)\n");
    } else {
      worked = true;
      EXPECT_EQ(outcome.exit_code, 0) << processes << ": " << outcome.err;
      EXPECT_EQ(outcome.out, free.out) << processes;
    }
  }
  EXPECT_TRUE(refused);
  EXPECT_TRUE(worked);
}

TEST_F(Limits, WithoutTheLibraryThatDrawsItIsSaidWhatToInstall) {
  make({"simulate room-2 -o room.bag"});
  fs::create_directory(folder_ / "bogus");
  std::ofstream(folder_ / "bogus/libOSMesa.so.8") << "no library";
  for (const char* arguments : {"compare room.bag --offsets-ms 19,24 -o out.png", "report room.bag -o out",
                                "view room.bag --headless --no-estimate --run 'screenshot out.png'"}) {
    const Outcome outcome = run(arguments, "LD_LIBRARY_PATH='" + (folder_ / "bogus").string() + "'");
    EXPECT_EQ(outcome.exit_code, 2) << arguments << ": " << outcome.err;
    EXPECT_EQ(outcome.err.rfind("sweepscope: Pictures cannot be drawn: install libOSMesa.so.8 (Debian's "
                                "package libosmesa6): ",
                                0),
              0U)
        << outcome.err;
    EXPECT_FALSE(exists("out")) << arguments << " begins its work all the same";
    EXPECT_FALSE(exists("out.png.candidates"));
  }
}

TEST_F(Limits, WithoutADisplayAWindowIsNoUnreadableInput) {
  for (const char* arguments : {"view", "compare a.pcd b.pcd -o out.png --draw-in window"}) {
    const Outcome outcome = run(arguments, "-u DISPLAY -u WAYLAND_DISPLAY");
    EXPECT_EQ(outcome.exit_code, 2) << arguments << ": " << outcome.err;
    EXPECT_NE(outcome.err.find("Without a display: --"), std::string::npos) << outcome.err;
  }
}

TEST_F(Limits, WhatAKilledRunUnpackedIsRemovedByTheNext) {
  make({"simulate room-2 -o room.bag", "convert room.bag -o room.mcap"});
  std::ofstream(folder_ / "room.mcap.zstd", std::ios::binary)
      << test::packed_by_zstd(test::contents_of(folder_ / "room.mcap"));
  fs::create_directory(folder_ / "tmp");
  const std::string there = " TMPDIR='" + (folder_ / "tmp").string() + "'";
  const test::SelfSignal killed{SIGKILL, "MCAP0"};  // what the unpacked file begins with
  ASSERT_EQ(run("info room.mcap.zstd", killed.environment() + there).exit_code, test::kKilled);
  ASSERT_FALSE(fs::is_empty(folder_ / "tmp"));
  const Outcome next = run("info room.bag", "-u DISPLAY" + there);
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_TRUE(fs::is_empty(folder_ / "tmp"));
}

}  // namespace
}  // namespace sweepscope
