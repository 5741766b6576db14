#pragma once

#include <cstdint>
#include <string>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A sensor_msgs/msg/LaserScan in ROS 2's serialisation (CDR, little-endian).
std::string cdr_laser_scan(const RawLaser& laser, std::size_t scan);
/// A sensor_msgs/msg/PointCloud2 in the same serialisation.
std::string cdr_cloud(const RawCloud& cloud);
/// A sensor_msgs/msg/JointState of one joint in the same serialisation.
std::string cdr_joint_state(const RawJoint& joint, std::size_t sample);

/// Their definitions with those that they use, as MCAP's schemas ("ros2msg") hold them.
std::string laser_scan_definition();
std::string point_cloud_definition();
std::string joint_state_definition();
/// The end of a definition: std_msgs/Header and what it uses.
std::string header_definition();

}  // namespace sweepscope
