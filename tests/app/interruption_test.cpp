// What every long command does when it is interrupted, or its output cannot be written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

using std::chrono::milliseconds;

/// A command line, in a folder that holds room.bag, walk.bag, recipe.yaml and wait.script, and the outputs
/// that it must not leave half written.
struct Case {
  const char* name;
  const char* arguments;
  const char* output;  // what it writes
  // When it is interrupted, beside at once: as soon as its progress bar names these phases, or once the file
  // is there. Each is followed by a hundred times the work that a signal needs.
  std::vector<std::string> phases = {};
  const char* file = nullptr;
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

const Case kCases[] = {
    {"estimate",
     "estimate walk.bag --method moving --range 14:34:0.1 --json out.json",
     "out.json",
     {"reading", "candidates"}},
    {"directly", "estimate walk.bag --json out.json", "out.json", {"reading", "features", "tracking"}},
    {"map", "map walk.bag --offset-ms 24 -o out.pcd", "out.pcd", {"reading", "tracking"}},
    {"compare", "compare walk.bag --offsets-ms 19,24 -o out.png", "out.png", {"reading", "candidates"}},
    {"figures", "figures recipe.yaml -o out", "out/curve.png", {"figures", "candidates"}},
    {"report", "report walk.bag -o out", "out/report.html", {"reading", "candidates"}},
    {"simulate", "simulate metro-station -o out.bag", "out.bag", {"casting"}},
    {"view", "view walk.bag --headless --script wait.script", "out.png", {}, "first.png"},
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

  pid_t begin(const std::string& arguments) const { return test::begin_program(folder_, arguments); }
  Outcome ended(pid_t child) const { return test::ended(child, folder_); }
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

/// Until the program handles the signal: before that its libraries are loaded, and any signal ends it.
void wait_until_it_listens(pid_t child, int signal) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    std::error_code gone;
    const auto program = std::filesystem::read_symlink("/proc/" + std::to_string(child) + "/exe", gone);
    // The shell that begins it handles signals of its own; so first who it is, and then what it handles.
    const bool begun = program == std::filesystem::canonical(SWEEPSCOPE_EXECUTABLE);
    const std::string status = test::contents_of("/proc/" + std::to_string(child) + "/status");
    const std::size_t at = status.find("SigCgt:");
    const unsigned long long caught =
        at == std::string::npos ? 0 : std::strtoull(status.c_str() + at + 7, nullptr, 16);
    if (begun && (caught >> (signal - 1) & 1) != 0) return;
    std::this_thread::sleep_for(milliseconds(1));
  }
  ADD_FAILURE() << "it never handles signal " << signal;
}

/// A program with a terminal as its stderr: there it draws how far it is.
class OnATerminal {
 public:
  explicit OnATerminal(const std::filesystem::path& folder, const std::string& arguments) {
    int terminal = -1;
    if (openpty(&screen_, &terminal, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("no terminal");
    const std::string command =
        "cd '" + folder.string() + "' && exec '" SWEEPSCOPE_EXECUTABLE "' " + arguments + " >said.out";
    child_ = fork();
    if (child_ == 0) {
      constexpr int kAfterTheTest = 3;  // who signals comes first, however busy the machine is
      (void)setpriority(PRIO_PROCESS, 0, kAfterTheTest);
      dup2(terminal, STDERR_FILENO);
      close(terminal);
      close(screen_);
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    close(terminal);
  }
  ~OnATerminal() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    close(screen_);
  }
  OnATerminal(const OnATerminal&) = delete;
  OnATerminal& operator=(const OnATerminal&) = delete;

  pid_t child() const { return child_; }
  bool has_ended() const {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == child_;
  }
  /// Until it has drawn these words; false where it ends without them.
  bool draws(const std::string& words) {
    while (drawn_.find(words) == std::string::npos)
      if (!read_more()) return false;
    return true;
  }
  /// All that it drew until its end, and its exit code.
  std::pair<std::string, int> end() {
    while (read_more()) {
    }
    int status = 0;
    waitpid(child_, &status, 0);
    return {drawn_, WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status)};
  }

 private:
  bool read_more() {
    constexpr int kLongest_ms = 120'000;
    pollfd ready{screen_, POLLIN, 0};
    if (poll(&ready, 1, kLongest_ms) <= 0) return false;
    char bytes[4096];
    const ssize_t got = read(screen_, bytes, sizeof bytes);  // fails once nobody draws any more
    if (got <= 0) return false;
    drawn_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }

  int screen_ = -1;
  pid_t child_ = -1;
  std::string drawn_;
};

class Signals : public Interruption {
 protected:
  /// The command is ended by a signal at differing moments: one sentence, exit code 130, within seconds.
  void interrupt(int signal) const {
    const Case& one = GetParam();
    interrupt_once(signal, "at once", [&](OnATerminal& program) {
      wait_until_it_listens(program.child(), signal);
      return true;
    });
    for (const std::string& phase : one.phases)
      interrupt_once(signal, phase, [&](OnATerminal& program) { return program.draws(phase + " "); });
    if (one.file != nullptr) {
      std::filesystem::remove(folder_ / one.file);
      interrupt_once(signal, one.file, [&](OnATerminal& program) {
        while (!std::filesystem::exists(folder_ / one.file)) {
          if (program.has_ended()) return false;
          std::this_thread::sleep_for(milliseconds(1));
        }
        return true;
      });
    }
  }

 private:
  void interrupt_once(int signal, const std::string& moment,
                      const std::function<bool(OnATerminal&)>& comes) const {
    OnATerminal program(folder_, GetParam().arguments);
    ASSERT_TRUE(comes(program)) << moment << " never came";
    kill(program.child(), signal);
    const auto begun = std::chrono::steady_clock::now();
    const auto [drawn, exit_code] = program.end();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10)) << moment;
    EXPECT_EQ(exit_code, 130) << moment << ": " << drawn;
    const std::size_t sentence = drawn.rfind("sweepscope: ");
    ASSERT_NE(sentence, std::string::npos) << moment << ": " << drawn;
    EXPECT_EQ(drawn.find("sweepscope: "), sentence) << "one sentence alone: " << drawn;
    EXPECT_EQ(lines_in(drawn.substr(sentence)), 1U) << "and it is the last: " << drawn;
    EXPECT_NE(drawn.find("nterrupted", sentence), std::string::npos) << drawn;
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

TEST_F(Interruption, AnInterruptedEstimateKeepsItsFinishedCandidates) {
  const std::string arguments =
      "estimate walk.bag --method moving --range 14:34:0.1 --json out.json --resume kept.candidates";
  const pid_t child = begin(arguments);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (lines_in(test::contents_of(folder_ / "kept.candidates")) < 5 &&
         std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(milliseconds(2));
  kill(child, SIGINT);
  const Outcome outcome = ended(child);
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
  Outcome interrupted_after(std::size_t lines) const {
    const pid_t child = begin(GetParam().arguments);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (kept_lines() < lines && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(milliseconds(2));
    kill(child, SIGINT);
    return ended(child);
  }
};

TEST_P(Keepers, GoOnFromWhereTheyWereInterrupted) {
  const Outcome first = interrupted_after(3);
  EXPECT_EQ(first.exit_code, 130) << first.err;
  EXPECT_NE(first.err.find(std::string("finished candidates are in ") + GetParam().output), std::string::npos)
      << first.err;
  const std::size_t kept = kept_lines();
  EXPECT_GE(kept, 3U);
  const Outcome second = interrupted_after(kept + 1);
  EXPECT_EQ(second.exit_code, 130) << second.err;
  EXPECT_GT(kept_lines(), kept);
}

INSTANTIATE_TEST_SUITE_P(WithoutBeingAsked, Keepers, ::testing::ValuesIn(kKeepers),
                         [](const auto& one) { return one.param.name; });

TEST_F(Interruption, AComparisonThatWentOnIsTheSameAndLeavesNothingBehind) {
  const std::string arguments = "compare walk.bag --offsets-ms 20,22 -o out.png";
  const pid_t child = begin(arguments);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (lines_in(test::contents_of(folder_ / "out.png.candidates")) < 3 &&
         std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(milliseconds(2));
  kill(child, SIGINT);
  ASSERT_EQ(ended(child).exit_code, 130);
  ASSERT_EQ(ended(begin(arguments)).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.png.candidates"));
  ASSERT_EQ(ended(begin("compare walk.bag --offsets-ms 20,22 -o whole.png")).exit_code, 0);
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
    {"view", "view room.bag --headless --run 'screenshot out.png'", "out.png"},
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
  expect_refused({std::atoi(both.c_str() + last), "", both.substr(0, last)}, "File too large");
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
