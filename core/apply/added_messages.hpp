#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/geometry/kinematics.hpp"
#include "core/geometry/map_cloud.hpp"
#include "core/geometry/pose.hpp"
#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// A cloud as sensor_msgs/PointCloud2 with the fields x, y, z (m), intensity and time (s since the stamp),
/// all float32. `begin_s` is the time of the stamp on the clock of the points' times.
std::string cloud_message(Encoding encoding, std::int64_t stamp_ns, std::string_view frame,
                          const MapCloud& cloud, double begin_s);

/// The laser's pose in the base frame at a motor angle.
Pose base_from_laser(const Mount& mount, double angle_rad);

/// One transform as tf2_msgs/TFMessage: p_in_parent = parent_from_child * p_in_child.
std::string transform_message(Encoding encoding, std::int64_t stamp_ns, std::string_view parent,
                              std::string_view child, const Pose& parent_from_child);

}  // namespace sweepscope
