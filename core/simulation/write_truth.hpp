#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope {

/// What is true of a simulation, as JSON: the offset, the walk's figures, and every option.
std::string truth_json(const Simulation& simulation);

/// The base frame's trajectory as TUM: `timestamp tx ty tz qx qy qz qw`, seconds since 1970 on the laser's
/// clock.
std::string truth_tum(const Simulation& simulation);

/// Writes both beside a bag: OUT.truth.json and OUT.truth.tum, where OUT is the bag's path without `.bag`.
Result<void> write_truth(const Simulation& simulation, const std::filesystem::path& bag_path);

/// The paths that write_truth writes to.
std::filesystem::path truth_json_path(const std::filesystem::path& bag_path);
std::filesystem::path truth_tum_path(const std::filesystem::path& bag_path);

}  // namespace sweepscope
