#include "core/geometry/kinematics.hpp"

#include <numbers>

namespace sweepscope {

Kinematics::Kinematics(const Rig::Mount& mount) : axis_(mount.axis.normalized()) {
  const Eigen::Vector3d rpy_rad = mount.laser_in_motor_rpy_deg * (std::numbers::pi / 180.0);
  motor_from_laser_.rotation = Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
  motor_from_laser_.translation_m = mount.laser_in_motor_xyz_m;
}

}  // namespace sweepscope
