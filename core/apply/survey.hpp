#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/apply/message_stream.hpp"
#include "core/recording/messages/messages.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// What a recording holds, as far as its stamps are to be moved. Takes memory for its topics and joints, and
/// none for its messages.
struct StreamSurvey {
  std::vector<StreamTopic> topics;         // each once, those without messages too
  std::vector<std::uint64_t> messages;     // of each topic
  std::optional<Compression> compression;  // of the first chunk; empty where there is no message
  /// Topics, lasers and joints for a choice: of a joint's positions the least and the greatest, of all stamps
  /// one that says which of the two there are.
  RawRecording raw;
  /// The least and the greatest stamps of each laser in `raw`, 0 where it has none.
  std::vector<MessageStamps> first_scans, last_scans;
  std::vector<std::string> warnings;
};

Result<StreamSurvey> survey(const StreamRecording& recording, const Rig& rig, const Job& job);

/// The messages whose stamps are moved.
struct MovedStream {
  std::string topic;
  std::string joint;  // of the motor; empty of the laser
  StampSource stamp = StampSource::kHeader;
  std::uint64_t messages = 0;              // of the joint, or of the laser
  std::int64_t first_ns = 0, last_ns = 0;  // of the laser, by that stamp
};

/// The motor's and the laser's stream, chosen as for an estimate; `stamps` overrides the rig.
Result<MovedStream> find_motor(StreamSurvey& survey, const Rig& rig, std::optional<StampSource> stamps);
Result<MovedStream> find_laser(StreamSurvey& survey, const Rig& rig, std::optional<StampSource> stamps);

/// Of a message's encoding by its name; empty where it is another one.
std::optional<Encoding> stream_encoding(const StreamTopic& topic);

/// What a message of CDR holds that rosbag2 packed by Zstandard (compression mode MESSAGE), in `buffer`;
/// other messages as they are; empty where it is damaged.
std::span<const std::byte> plain_message(const StreamTopic& topic, std::span<const std::byte> message,
                                         std::vector<std::byte>& buffer);

}  // namespace sweepscope
