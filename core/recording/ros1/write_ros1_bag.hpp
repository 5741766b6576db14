#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// An IMU's gyroscope as a topic of sensor_msgs/Imu.
struct RawImu {
  std::string topic;
  RawTurnRates rates;
};

/// Writes a laser and a motor's joint as a ROS 1 bag (format 2.0, chunks as they are, bz2 or lz4):
/// sensor_msgs/LaserScan and sensor_msgs/JointState on the topics that they name, in the order in which they
/// were received, and an IMU if there is one; a message without a receive time gets its header stamp. Equal
/// input gives equal bytes. Written beside the path and then renamed; if that fails,
/// ExitCode::kUnreadableInput.
Result<void> write_ros1_bag(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                            const std::string& compression, const Job& job,
                            const std::optional<RawImu>& imu = std::nullopt);

}  // namespace sweepscope
