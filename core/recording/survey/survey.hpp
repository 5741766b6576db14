#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// A topic of scans, or of clouds that are read as scans.
struct LaserChoice {
  std::string topic;
  bool of_clouds = false;
  std::size_t scans = 0, max_beams = 0;
  double rate_hz = 0;  // 0: not known

  bool operator==(const LaserChoice&) const = default;
};

/// A joint of one topic. A number and a transform are joints too: see JointSource.
struct JointChoice {
  std::string topic, joint;
  JointSource source = JointSource::kJointState;
  std::size_t samples = 0;
  double turned_deg = 0;  // greatest minus least angle, by the rig's scale

  bool operator==(const JointChoice&) const = default;
};

/// What can be chosen when a recording is opened, what is chosen with a rig, and a sentence for everything
/// that is missing or ambiguous. Sentences name no file.
struct RecordingSurvey {
  std::vector<LaserChoice> lasers;           // that hold scans, in the order of the file
  std::vector<JointChoice> joints;           // that hold samples, in the order of the file
  std::optional<std::size_t> laser, joint;   // chosen, of those
  std::string laser_problem, joint_problem;  // why none is chosen; empty: one is
  bool header_stamps = false;                // of the chosen laser's scans, or of any
  bool receive_stamps = false;               // the same
  std::string mount_note;                    // what the transforms say about the mount
  std::vector<RecordedTopic> topics;         // of the whole file

  /// Whether it can be read like this.
  bool complete() const { return laser.has_value() && joint.has_value(); }
};

/// A survey of all streams of a file: `raw` was read with a rig that names none of them, and `rig` is the one
/// that it is to be read with.
RecordingSurvey survey(const RawRecording& raw, const Rig& rig);

/// The rig without the names of laser and motor, so that every stream is read; a stream of which it names a
/// field stays named.
Rig without_streams(Rig rig);

}  // namespace sweepscope
