#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/formats/read_recording.hpp"

namespace sweepscope {

/// The rig of a recording, as far as it can be detected, and the source of each setting: a note for a person,
/// empty if there is none.
struct DetectedRig {
  Rig rig;
  std::string recording;
  std::string laser_note, stamp_at_note, increment_note, motor_note, scale_note, mount_note;
  std::string play_note, encoder_note;       // of the gear
  bool mount_found = false;                  // in the recording's transforms
  std::vector<RecordedTopic> motion_topics;  // of sensor_msgs/Imu and nav_msgs/Odometry
};

/// Reads a recording and returns the rig that it is read with: `options.rig`, completed from the recording.
/// If the rig does not give the mount, it is taken from transforms (/tf_static and /tf): those between the
/// laser's frame and the first frame that turns are the laser's pose in the motor's frame, and the turning
/// one gives the axis, in its parent frame, with the sign that makes the motor's angle grow. The stamp is
/// assumed to be the last beam's if scans were received too early for a stamp at the first.
Result<DetectedRig> detect_rig(const std::filesystem::path& recording, const ReadOptions& options,
                               const Job& job);

/// The rig as a file with comments, which `read_rig` reads back as the same settings.
std::string rig_file_text(const DetectedRig& detected);

}  // namespace sweepscope
