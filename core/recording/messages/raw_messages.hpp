#pragma once

#include <cstddef>
#include <string>

#include "core/recording/messages/messages.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A scan as sensor_msgs/LaserScan, or where the laser's are clouds a cloud as sensor_msgs/PointCloud2.
std::string message_of(Encoding encoding, const RawLaser& laser, std::size_t number);
/// A sample as sensor_msgs/JointState of one joint.
std::string message_of(Encoding encoding, const RawJoint& joint, std::size_t number);
/// A measurement as sensor_msgs/Imu, in the frame "imu".
std::string message_of(Encoding encoding, const RawTurnRates& rates, std::size_t number);

}  // namespace sweepscope
