#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// The mount of a laser, from a recording's transforms.
struct FrameMount {
  /// The chain of frames from the laser's to the one that turns with the motor; that one is the last.
  std::vector<std::string> chain;
  std::string parent;  // of the frame that turns; empty if none turns
  Eigen::Quaterniond motor_from_laser_rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d laser_in_motor_m = Eigen::Vector3d::Zero();
  /// The turning frame's pose, its axis in the parent frame, unit length, of either sign.
  std::optional<RawFrame> turning;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
};

/// Follows the transforms up from the laser's frame to the first frame that turns. Empty if the laser's frame
/// has none.
std::optional<FrameMount> mount_from_frames(const std::vector<RawFrame>& frames,
                                            const std::string& laser_frame);

/// The mount as a rig file has it: the base frame has the parent frame's axes, and at motor angle 0 the frame
/// that turns is turned as it was at the first transform less `first_rad`, the motor's angle then.
/// `sign`: -1 where the motor's angle grows as the frame turns the other way about `found.axis`.
Rig::Mount rig_mount(const FrameMount& found, double first_rad, double sign);

/// The mount by a frame that turns with the motor, at the motor's angles when its transforms were stamped.
/// Absent if no frame turns, or if the transforms do not fit these angles.
std::optional<Rig::Mount> fitted_mount(const FrameMount& found, const Recording& recording);

}  // namespace sweepscope
