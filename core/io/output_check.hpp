#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// The files that one run reads and those that it writes.
struct RunFiles {
  std::vector<std::filesystem::path> inputs, outputs;
  std::filesystem::path folder;  // of outputs; the run makes it where it does not exist. Empty: none
};

/// Refuses, before anything is read or written, an output that cannot be created as things stand (see
/// check_writable), an output that is an input, and two outputs that are one file. Files are the same by
/// name, by hard link or by symbolic link. Pipes and devices hold nothing that could be lost, and are left
/// out. Inputs that do not exist are the business of those who read them. Errors are ExitCode::kWrongUsage.
Result<void> check_run_files(const RunFiles& files);

}  // namespace sweepscope
