#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/apply/provenance.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// A system that reads the mount of a laser, in its own notation; or the laser's driver, which takes the
/// offset.
enum class RigSystem {
  kUrdf,
  kXacro,
  kRos2StaticTf,
  kLaserAssembler,
  kCartographer,
  kFastLio,
  kDriverParams
};

/// As the command line spells them, in the order of the enum.
const std::vector<std::string>& rig_system_names();

/// What a snippet is made of. The motor's axis goes through the origin of the base frame.
struct RigSnippet {
  Rig rig;
  AppliedOffset offset;
  std::string base_frame = "base_link", motor_frame = "motor_link", laser_frame = "laser";
  std::string source;  // the recording or rig file, for the comment
};

/// The mount and the offset as that system reads them, with comments that name the public documentation that
/// the notation follows, and say what to do with an offset for which the system has no place.
std::string rig_snippet(const RigSnippet& snippet, RigSystem system);

/// Roll, pitch and yaw (rad) about the fixed axes x, y and z, in this order: R = Rz(yaw) Ry(pitch) Rx(roll),
/// as in URDF and tf2. Pitch in [-pi/2, pi/2]; where it is at an end, yaw is 0.
Eigen::Vector3d rpy_rad_of(const Eigen::Quaterniond& rotation);

}  // namespace sweepscope
