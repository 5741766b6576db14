#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// The files that one run reads and writes.
struct RunFiles {
  std::vector<std::filesystem::path> inputs, outputs;
  std::filesystem::path folder;  // of the outputs; created if it does not exist. Empty: none
};

/// Checks, before anything is read or written, that every output can be created (see check_writable), that no
/// output is an input, and that no two outputs are the same file, by name, hard link or symbolic link. Pipes
/// and devices are not checked: they hold nothing that could be lost. Neither are missing inputs, which fail
/// when they are read. Errors are ExitCode::kWrongUsage.
Result<void> check_run_files(const RunFiles& files);

}  // namespace sweepscope
