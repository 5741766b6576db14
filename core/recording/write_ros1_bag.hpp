#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Writes a laser and a motor's joint as a ROS 1 bag (format 2.0, chunks as they are, bz2 or lz4):
/// sensor_msgs/LaserScan and sensor_msgs/JointState on the topics that they name, in the order in which they
/// were received; a message without a receive time takes its header stamp for it. Equal input gives equal
/// bytes. Written beside the path and then renamed; where that fails, ExitCode::kUnreadableInput.
Result<void> write_ros1_bag(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                            const std::string& compression, const Job& job);

}  // namespace sweepscope
