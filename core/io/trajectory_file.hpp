#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/pose.hpp"

namespace sweepscope {

/// Writes the trajectory as TUM text: one line per pose, "time x y z qx qy qz qw", in seconds and metres. The
/// poses' times count from `epoch_ns` (Recording::epoch_ns), the file's from 0.
Result<void> write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory,
                       std::int64_t epoch_ns = 0);

/// Reads such a file; lines that are empty or begin with # are skipped. Times must be strictly ascending.
Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path, std::int64_t epoch_ns = 0);

}  // namespace sweepscope
