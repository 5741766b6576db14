#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/recording/messages/messages.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// The topics, lasers and joints of a recording, without its messages.
struct StreamSurvey {
  std::vector<StreamTopic> topics;         // each once, also those without messages
  std::vector<std::uint64_t> messages;     // of each topic
  std::optional<Compression> compression;  // of the first chunk; empty where there is no message
  /// Enough to choose streams: the minimum and maximum of a joint's positions, and of all stamps one that
  /// shows whether there are header and receive times.
  RawRecording raw;
  /// The earliest and latest stamps of each laser in `raw`; 0 if it has none.
  std::vector<MessageStamps> first_scans, last_scans;
  std::vector<std::string> warnings;
};

Result<StreamSurvey> survey(const StreamRecording& recording, const Rig& rig, const Job& job);

/// The messages whose stamps are moved.
struct MovedStream {
  std::string topic;
  std::string joint;  // of the motor; empty of the laser
  std::string frame;  // of the laser's messages; empty of the motor
  StampSource stamp = StampSource::kHeader;
  std::uint64_t messages = 0;              // of the joint, or of the laser
  std::int64_t first_ns = 0, last_ns = 0;  // of the laser, by that stamp
};

/// The motor's and the laser's stream, chosen as for an estimate; `stamps` overrides the rig.
Result<MovedStream> find_motor(StreamSurvey& survey, const Rig& rig, std::optional<StampSource> stamps);
Result<MovedStream> find_laser(StreamSurvey& survey, const Rig& rig, std::optional<StampSource> stamps);

/// The encoding of a topic's messages; absent if it is not known.
std::optional<Encoding> stream_encoding(const StreamTopic& topic);

/// Decompresses a CDR message that rosbag2 compressed (compression mode MESSAGE) into `buffer`. Other
/// messages are returned as they are; empty if it is damaged.
std::span<const std::byte> plain_message(const StreamTopic& topic, std::span<const std::byte> message,
                                         std::vector<std::byte>& buffer);

}  // namespace sweepscope
