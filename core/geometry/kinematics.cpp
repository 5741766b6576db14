#include "core/geometry/kinematics.hpp"

#include "core/geometry/roll_pitch_yaw.hpp"

namespace sweepscope {

Kinematics::Kinematics(const Rig::Mount& mount) : axis_(mount.axis.normalized()) {
  motor_from_laser_.rotation = rotation_from_rpy(mount.laser_in_motor_rpy_deg);
  motor_from_laser_.translation_m = mount.laser_in_motor_xyz_m;
}

}  // namespace sweepscope
