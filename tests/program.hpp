#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

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
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
};

}  // namespace sweepscope::test
