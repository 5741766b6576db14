#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <span>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// Where the rig's base frame was in the map frame at an instant of the laser's clock.
struct StampedPose {
  double time_s = 0;  // seconds since Recording::epoch_ns
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // map_from_base
};

/// Writes the trajectory as TUM text: one line per pose, "time x y z qx qy qz qw", in seconds and metres.
Result<void> write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory);

/// Reads such a file; lines that are empty or begin with # are skipped. Times must ascend strictly.
Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path);

}  // namespace sweepscope
