#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// What a recording's file holds before anything is chosen, ordered or judged: the same for every format.

/// When a message says it was made, and when it was received; ns, 0 where it does not say.
struct MessageStamps {
  std::int64_t header_ns = 0;
  std::int64_t receive_ns = 0;
};

struct RawScan {
  MessageStamps stamps;
  float angle_min_rad = 0, angle_increment_rad = 0;
  float time_increment_s = 0, scan_time_s = 0;
  float range_min_m = 0, range_max_m = 0;
  std::size_t first_range = 0;  // of beam 0 in RawLaser::ranges_m
  std::uint32_t beams = 0;
};

/// The scans of one topic in the order of the file.
struct RawLaser {
  std::string topic;
  std::vector<RawScan> scans;
  std::vector<float> ranges_m;
  std::vector<float> intensities;  // like ranges_m as long as every scan had them
  bool has_intensities = true;
};

/// The samples of one joint of one topic in the order of the file.
struct RawJoint {
  std::string topic;
  std::string joint;
  std::vector<MessageStamps> stamps;
  std::vector<double> positions;  // raw: before the rig's scale and zero
};

struct RawRecording {
  std::string file;  // as given, for messages
  std::string name;
  std::vector<RecordedTopic> topics;
  std::vector<RawLaser> lasers;
  std::vector<RawJoint> joints;
  std::vector<std::string> warnings;
};

}  // namespace sweepscope
