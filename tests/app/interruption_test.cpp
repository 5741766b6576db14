// What every long command does when it is interrupted, or its output cannot be written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/app/self_signal.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

/// A command line, in a folder that holds room.bag, walk.bag, recipe.yaml and wait.script, and the outputs
/// that it must not leave half written.
struct Case {
  const char* name;
  const char* arguments;
  const char* output;  // what it writes
  // When it is interrupted, beside at once: as soon as its progress bar names these phases, or this file is
  // there.
  std::vector<std::string> moments = {};
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

const Case kCases[] = {
    {"estimate",
     "estimate walk.bag --method moving --range 14:34:0.1 --json out.json",
     "out.json",
     {"reading ", "candidates "}},
    {"directly", "estimate walk.bag --json out.json", "out.json", {"reading ", "features ", "tracking "}},
    {"map", "map walk.bag --offset-ms 24 -o out.pcd", "out.pcd", {"reading ", "tracking "}},
    {"compare", "compare walk.bag --offsets-ms 19,24 -o out.png", "out.png", {"reading ", "candidates "}},
    {"figures", "figures recipe.yaml -o out", "out/curve.png", {"figures ", "candidates "}},
    {"report", "report walk.bag -o out", "out/report.html", {"reading ", "candidates "}},
    {"simulate", "simulate metro-station -o out.bag", "out.bag", {"casting "}},
    {"view", "view walk.bag --headless --no-estimate --script wait.script", "out.png", {"first.png"}},
};

/// Makes the inputs once; each test works in a copy.
class Interruption : public test::ProgramTest, public ::testing::WithParamInterface<Case> {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<test::ScratchFolder>();
    inputs_ = scratch_->path();
    for (const char* arguments :
         {"simulate metro-station -o walk.bag --duration-s 20", "simulate room-2 -o room.bag"})
      ASSERT_EQ(test::run_program(inputs_, arguments).exit_code, 0);
    std::ofstream(inputs_ / "recipe.yaml")
        << "recordings: {walk: {file: walk.bag}}\n"
           "estimates: {walk: {recording: walk, method: moving, ranges_ms: [[14, 34, 0.1]]}}\n"
           "figures: {curve: {kind: curves, estimates: walk}}\n";
    std::ofstream(inputs_ / "wait.script")
        << "screenshot first.png\nestimate\nwait estimated\nscreenshot out.png\n";
  }
  static void TearDownTestSuite() { scratch_.reset(); }
  void SetUp() override {
    for (const char* name : {"walk.bag", "room.bag", "recipe.yaml", "wait.script"})
      std::filesystem::copy(inputs_ / name, folder_ / name);
  }

  std::string said(const std::string& where) const { return test::contents_of(folder_ / ("said." + where)); }

  /// Names of the files that were not there before, in the folder and below.
  std::vector<std::string> made() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().lexically_relative(folder_).string();
      if (entry.is_regular_file() && !std::filesystem::exists(inputs_ / name) && name != "said.out" &&
          name != "said.err")
        names.push_back(name);
    }
    return names;
  }
  void expect_nothing_half_written() const {
    for (const std::string& name : made())
      EXPECT_FALSE(name.ends_with(".part")) << name << " was left behind";
  }

  static std::unique_ptr<test::ScratchFolder> scratch_;
  static std::filesystem::path inputs_;
};
std::unique_ptr<test::ScratchFolder> Interruption::scratch_;
std::filesystem::path Interruption::inputs_;

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

struct Drawn {
  std::string text;
  int exit_code = -1;
};

/// Runs the program with a terminal as its stderr: there it draws how far it is.
Drawn run_on_a_terminal(const std::filesystem::path& folder, const std::string& arguments,
                        const std::string& environment) {
  int screen = -1, terminal = -1;
  if (openpty(&screen, &terminal, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("no terminal");
  const std::string command = "cd '" + folder.string() + "' && exec env " + environment +
                              " '" SWEEPSCOPE_EXECUTABLE "' " + arguments + " >said.out";
  const pid_t child = fork();
  if (child == 0) {
    dup2(terminal, STDERR_FILENO);
    close(terminal);
    close(screen);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  close(terminal);
  Drawn drawn;
  char bytes[4096];
  for (ssize_t got = 0; (got = read(screen, bytes, sizeof bytes)) > 0;)  // fails once nobody draws any more
    drawn.text.append(bytes, static_cast<std::size_t>(got));
  close(screen);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) drawn.exit_code = WEXITSTATUS(status);
  return drawn;
}

class Signals : public Interruption {
 protected:
  /// The command is ended by a signal at differing moments: one sentence, and exit code 130.
  void interrupt(int signal) const {
    interrupt_once({signal, ""});
    for (const std::string& moment : GetParam().moments) interrupt_once({signal, moment});
  }

 private:
  void interrupt_once(const test::SelfSignal& signal) const {
    const std::string moment = signal.words.empty() ? "at once" : signal.words;
    const Drawn drawn = run_on_a_terminal(folder_, GetParam().arguments, signal.environment());
    EXPECT_EQ(drawn.exit_code, 130) << moment << ": " << drawn.text;
    const std::size_t sentence = drawn.text.rfind("sweepscope: ");
    ASSERT_NE(sentence, std::string::npos) << moment << ": " << drawn.text;
    EXPECT_EQ(drawn.text.find("sweepscope: "), sentence) << "one sentence alone: " << drawn.text;
    EXPECT_EQ(lines_in(drawn.text.substr(sentence)), 1U) << "and it is the last: " << drawn.text;
    EXPECT_NE(drawn.text.find("nterrupted", sentence), std::string::npos) << drawn.text;
    expect_nothing_half_written();
  }
};

TEST_P(Signals, CtrlCEndsItWithOneSentence) {
  interrupt(SIGINT);
}

TEST_P(Signals, TerminationEndsItWithOneSentence) {
  interrupt(SIGTERM);
}

INSTANTIATE_TEST_SUITE_P(OfEveryCommand, Signals, ::testing::ValuesIn(kCases),
                         [](const auto& one) { return one.param.name; });

constexpr const char* kKept = "offset_ns";  // in the line of every candidate that is kept

TEST_F(Interruption, AnInterruptedEstimateKeepsItsFinishedCandidates) {
  const std::string arguments =
      "estimate walk.bag --method moving --range 14:34:0.1 --json out.json --resume kept.candidates";
  const Outcome outcome = run(arguments, test::SelfSignal{SIGINT, kKept, 5}.environment());
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("finished candidates are in kept.candidates"), std::string::npos) << outcome.err;
  EXPECT_GE(lines_in(test::contents_of(folder_ / "kept.candidates")), 5U);
  const auto json = nlohmann::json::parse(test::contents_of(folder_ / "out.json"));
  EXPECT_EQ(json["identifiable"], false);
  EXPECT_GE(json["curve"].size(), 1U);
}

/// Commands that keep candidates without being asked, and the file that they keep them in.
const Case kKeepers[] = {
    {"compare", "compare walk.bag --offsets-ms 19,24 -o out.png", "out.png.candidates"},
    {"figures", "figures recipe.yaml -o out", "out/cache"},
    {"report", "report walk.bag -o out", "out/report.candidates"},
};

class Keepers : public Interruption {
 protected:
  /// The lines of the kept file; of a folder: of the one in it.
  std::size_t kept_lines() const {
    std::filesystem::path path = folder_ / GetParam().output;
    if (std::filesystem::is_directory(path)) {
      for (const auto& entry : std::filesystem::directory_iterator(path))
        if (entry.path().extension() == ".candidates") path = entry.path();
    }
    return std::filesystem::is_regular_file(path) ? lines_in(test::contents_of(path)) : 0;
  }
  Outcome interrupted_after(int candidates) const {
    return run(GetParam().arguments, test::SelfSignal{SIGINT, kKept, candidates}.environment());
  }
};

TEST_P(Keepers, GoOnFromWhereTheyWereInterrupted) {
  const Outcome first = interrupted_after(3);
  EXPECT_EQ(first.exit_code, 130) << first.err;
  EXPECT_NE(first.err.find(std::string("finished candidates are in ") + GetParam().output), std::string::npos)
      << first.err;
  const std::size_t kept = kept_lines();
  EXPECT_GE(kept, 3U);
  const Outcome second = interrupted_after(1);
  EXPECT_EQ(second.exit_code, 130) << second.err;
  EXPECT_GT(kept_lines(), kept);
}

INSTANTIATE_TEST_SUITE_P(WithoutBeingAsked, Keepers, ::testing::ValuesIn(kKeepers),
                         [](const auto& one) { return one.param.name; });

TEST_F(Interruption, AComparisonThatWentOnIsTheSameAndLeavesNothingBehind) {
  const std::string arguments = "compare walk.bag --offsets-ms 20,22 -o out.png";
  ASSERT_EQ(run(arguments, test::SelfSignal{SIGINT, kKept, 3}.environment()).exit_code, 130);
  ASSERT_EQ(run(arguments).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.png.candidates"));
  ASSERT_EQ(run("compare walk.bag --offsets-ms 20,22 -o whole.png").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "out.png"), test::contents_of(folder_ / "whole.png"));
}

/// Outputs that cannot be written: quick commands.
const Case kWriters[] = {
    {"estimate_json", "estimate room.bag --method stationary --range 23:25:1 --json out.json", "out.json"},
    {"estimate_csv", "estimate room.bag --method stationary --range 23:25:1 --csv out.csv", "out.csv"},
    {"estimate_candidates",
     "estimate room.bag --method stationary --range 23:25:1 --shard 1/1 --resume out.candidates",
     "out.candidates"},
    {"info_json", "info room.bag --json out.json", "out.json"},
    {"map", "map room.bag --offset-ms 24 -o out.pcd", "out.pcd"},
    {"trajectory", "map room.bag --offset-ms 24 -o ../map.ply --trajectory out.tum", "out.tum"},
    {"compare_png", "compare room.bag --offsets-ms 19,24 --no-curve -o out.png", "out.png"},
    {"compare_svg", "compare room.bag --offsets-ms 19,24 --no-curve -o out.svg", "out.svg"},
    {"compare_pdf", "compare room.bag --offsets-ms 19,24 --no-curve -o out.pdf", "out.pdf"},
    {"figures", "figures recipe.yaml -o out", "out"},
    {"report", "report room.bag -o out", "out"},
    {"simulate", "simulate room-1 -o out.bag", "out.bag"},
    {"view", "view room.bag --headless --no-estimate --run 'screenshot out.png'", "out.png"},
};

std::vector<Case> writers(std::initializer_list<std::string> names) {
  std::vector<Case> chosen;
  for (const Case& one : kWriters)
    if (std::ranges::find(names, one.name) != names.end()) chosen.push_back(one);
  return chosen;
}

class Outputs : public Interruption {
 protected:
  void SetUp() override {
    Interruption::SetUp();
    std::ofstream(folder_ / "recipe.yaml")
        << "recordings: {room: {file: room.bag}}\nfigures: {scan: {kind: scan, recording: room, at_s: 1}}\n";
    std::filesystem::create_directory(folder_ / "to");
  }
  /// The arguments, with the output in `folder` instead.
  static std::string written_to(const Case& one, const std::string& folder) {
    std::string arguments = one.arguments;
    const std::string output = one.output;
    const std::size_t at = arguments.rfind(output);
    return arguments.replace(at, output.size(), folder + "/" + output);
  }
  void expect_refused(const Outcome& outcome, const std::string& reason) const {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    const std::size_t sentence = outcome.err.rfind("sweepscope: ");
    ASSERT_NE(sentence, std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("sweepscope: "), sentence) << "one sentence alone: " << outcome.err;
    EXPECT_EQ(lines_in(outcome.err.substr(sentence)), 1U) << "and it is the last: " << outcome.err;
    EXPECT_NE(outcome.err.find(GetParam().output), std::string::npos) << "names the file: " << outcome.err;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    expect_nothing_half_written();
  }
};

TEST_P(Outputs, OfAFullDiskAreRefused) {
  const std::string mount =
      "unshare -rm sh -c 'mount -t tmpfs -o size=4k none to && dd if=/dev/zero of=to/filler bs=4096 count=1 "
      "2>/dev/null && exec \"$@\"' sh ";
  if (std::system("unshare -rm sh -c 'mount -t tmpfs -o size=4k none /mnt' 2>/dev/null") != 0)
    GTEST_SKIP() << "this machine lets no test mount a small disk";
  const std::string command =
      "env -u DISPLAY " + mount + "'" SWEEPSCOPE_EXECUTABLE "' " + written_to(GetParam(), "to");
  expect_refused(test::run_shell(folder_, command), "No space left on device");
}

/// Those of commands that write nothing before them and draw nothing: Mesa draws in a file without a disk, to
/// which the limit of a file's size applies as well.
class FirstOutputs : public Outputs {};

TEST_P(FirstOutputs, OverTheLimitOfAFilesSizeAreRefused) {
  const std::string limited = "( ulimit -f 0; exec env -u DISPLAY '" SWEEPSCOPE_EXECUTABLE "' " +
                              written_to(GetParam(), "to") + " ) 2>&1 >/dev/null; echo $?";
  ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && { " + limited + "; } | cat >said.both").c_str()),
            0);
  const std::string both = test::contents_of(folder_ / "said.both");
  const std::size_t last = both.rfind('\n', both.size() - 2) + 1;
  expect_refused({std::stoi(both.substr(last)), "", both.substr(0, last)}, "File too large");
}

INSTANTIATE_TEST_SUITE_P(OfCommands, FirstOutputs,
                         ::testing::ValuesIn(writers({"estimate_json", "estimate_csv", "estimate_candidates",
                                                      "info_json", "map", "simulate"})),
                         [](const auto& one) { return one.param.name; });

TEST_P(Outputs, InAFolderThatIsReadOnlyAreRefused) {
  if (geteuid() == 0) {
    // Root may write anywhere but where there is no disk to write to.
    expect_refused(run(written_to(GetParam(), "/proc")), "");
    return;
  }
  std::filesystem::permissions(folder_ / "to",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_refused(run(written_to(GetParam(), "to")), "Permission denied");
}

/// Those of work that takes its time.
class SlowOutputs : public Outputs {};

TEST_P(SlowOutputs, InNoFolderAreRefusedBeforeTheWork) {
  // There is no recording: what is refused without it is refused before all work.
  std::filesystem::remove(folder_ / "room.bag");
  expect_refused(run(written_to(GetParam(), "nowhere")), "No such file or directory");
}

TEST_F(Interruption, AnAnswerWhoseFilesCannotBeWrittenIsSaidAllTheSame) {
  const std::string limited = "( ulimit -f 0; exec '" SWEEPSCOPE_EXECUTABLE
                              "' estimate room.bag --json out.json 2>/dev/null; ) | cat >said.out";
  ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && " + limited).c_str()), 0);
  EXPECT_EQ(said("out").rfind("offset   2", 0), 0U) << said("out");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.json"));
}

INSTANTIATE_TEST_SUITE_P(OfCommands, SlowOutputs,
                         ::testing::ValuesIn(writers({"estimate_json", "estimate_csv", "map", "trajectory",
                                                      "compare_png"})),
                         [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(OfEveryCommand, Outputs, ::testing::ValuesIn(kWriters),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace sweepscope
