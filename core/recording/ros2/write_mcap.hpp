#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Writes a laser and a motor's joint as an MCAP file of ROS 2's profile, with chunks ("none", "lz4" or
/// "zstd"), their checksums and indexes: sensor_msgs/msg/LaserScan and sensor_msgs/msg/JointState on the
/// topics that they name, in the order in which they were received; a message without a receive time gets its
/// header stamp. Equal input gives equal bytes. Written completely or not at all.
Result<void> write_mcap(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                        const std::string& compression, const Job& job);

}  // namespace sweepscope
