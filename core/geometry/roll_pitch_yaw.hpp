#pragma once

#include <Eigen/Geometry>
#include <numbers>

namespace sweepscope {

/// Rz(yaw) Ry(pitch) Rx(roll) of an `rpy_deg`, as rig files and ROS have it.
inline Eigen::Quaterniond rotation_from_rpy(const Eigen::Vector3d& rpy_deg) {
  const Eigen::Vector3d rpy_rad = rpy_deg * (std::numbers::pi / 180.0);
  return Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
}

}  // namespace sweepscope
