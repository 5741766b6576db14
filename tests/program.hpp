#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/folder_test.hpp"

/// Runs of the shipped executable. Their words go to said.out and said.err in the folder that they run in.
namespace sweepscope::test {

struct Outcome {
  int exit_code = -1;  // less the signal's number where one ended it
  std::string out, err;
};

inline Outcome outcome_of(int status, const std::filesystem::path& folder) {
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), contents_of(folder / "said.out"),
          contents_of(folder / "said.err")};
}

/// A command for a shell, in a folder.
inline Outcome run_shell(const std::filesystem::path& folder, const std::string& command) {
  const std::string line = "cd '" + folder.string() + "' && { " + command + "; } >said.out 2>said.err";
  return outcome_of(std::system(line.c_str()), folder);
}

/// `environment` as env(1) takes it, such as "-u DISPLAY".
inline Outcome run_program(const std::filesystem::path& folder, const std::string& arguments,
                           const std::string& environment = "-u DISPLAY") {
  return run_shell(folder, "env " + environment + " '" SWEEPSCOPE_EXECUTABLE "' " + arguments);
}

/// A test that runs the executable in a folder of its own.
class ProgramTest : public FolderTest {
 protected:
  using Outcome = test::Outcome;

  Outcome run(const std::string& arguments, const std::string& environment = "-u DISPLAY") const {
    return run_program(folder_, arguments, environment);
  }
  /// Puts here what these command lines make in an empty folder. They run once per program of tests.
  void make(const std::vector<std::string>& commands) const {
    static std::map<std::vector<std::string>, std::unique_ptr<ScratchFolder>> made;
    if (!made.contains(commands)) {
      auto folder = std::make_unique<ScratchFolder>();
      for (const std::string& command : commands) {
        const Outcome outcome = run_program(folder->path(), command);
        ASSERT_EQ(outcome.exit_code, 0) << command << ": " << outcome.err;
      }
      for (const char* said : {"said.out", "said.err"}) std::filesystem::remove(*folder / said);
      made[commands] = std::move(folder);
    }
    std::filesystem::copy(made[commands]->path(), folder_, std::filesystem::copy_options::recursive);
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
};

}  // namespace sweepscope::test
