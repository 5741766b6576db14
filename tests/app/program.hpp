#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/core/io/test_files.hpp"

namespace sweepscope::test {

/// A test that runs the shipped executable in a folder of its own.
class ProgramTest : public FolderTest {
 protected:
  struct Outcome {
    int exit_code = -1;
    std::string out, err;
  };

  /// `environment` as env(1) takes it, such as "-u DISPLAY".
  Outcome run(const std::string& arguments, const std::string& environment = "-u DISPLAY") const {
    const std::string command = "cd '" + folder_.string() + "' && env " + environment +
                                " '" SWEEPSCOPE_EXECUTABLE "' " + arguments + " >said.out 2>said.err";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents_of(folder_ / "said.out"),
            contents_of(folder_ / "said.err")};
  }

  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
};

}  // namespace sweepscope::test
