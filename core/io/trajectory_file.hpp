#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/pose.hpp"

namespace sweepscope {

/// Writes the trajectory as TUM text: one line per pose, "time x y z qx qy qz qw", in seconds and metres.
Result<void> write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory);

/// Reads such a file; lines that are empty or begin with # are skipped. Times must ascend strictly.
Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path);

}  // namespace sweepscope
