#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// Checks, before anything is read, what `apply` will write: the recording `output` (empty: none) and the
/// sweeps in the folder `sweeps`. `others` are the files that are read besides the recording. For the errors
/// see check_run_files.
Result<void> check_apply_files(const std::filesystem::path& recording, const std::filesystem::path& output,
                               const std::optional<std::filesystem::path>& sweeps,
                               std::vector<std::filesystem::path> others);

}  // namespace sweepscope
