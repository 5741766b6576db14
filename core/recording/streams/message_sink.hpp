#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// Writes a recording, message by message in the order of its file. The file appears complete and with its
/// index at `finish`, or not at all. Takes memory for one chunk and the index.
class MessageSink {
 public:
  MessageSink() = default;
  virtual ~MessageSink() = default;
  MessageSink(const MessageSink&) = delete;
  MessageSink& operator=(const MessageSink&) = delete;

  /// Call for topics 0, 1, 2 ... before their messages. A topic that the format cannot hold is
  /// ExitCode::kWrongUsage.
  virtual Result<void> add_topic(const StreamTopic& topic) = 0;
  virtual Result<void> write(const StreamMessage& message) = 0;
  /// Call once, last. `records` go beside the messages: see the names below.
  virtual Result<void> finish(const std::vector<std::string>& records) = 0;
};

/// Where the records of an applied offset are: a topic of std_msgs/String in a ROS 1 bag, metadata records in
/// an MCAP file, a table in a database.
inline constexpr const char* kAppliedTopic = "/sweepscope/applied";
inline constexpr const char* kAppliedMetadata = "sweepscope.apply";
inline constexpr const char* kAppliedTable = "sweepscope_apply";

/// The size of chunks, as the reference writers of bags and of MCAP files have it.
inline constexpr std::size_t kChunk_bytes = std::size_t{768} << 10;

/// A ROS 1 bag of format 2.0; chunks are compressed as `compression` says (none, bz2 or LZ4).
Result<std::unique_ptr<MessageSink>> create_ros1_sink(const std::filesystem::path& path,
                                                      Compression compression);

/// An MCAP file; chunks are compressed as `compression` says (none, LZ4 or Zstandard). Attachments,
/// metadata and private records of the MCAP files `kept_from` are copied, and the profile of the first;
/// `profile` is used if there is none.
Result<std::unique_ptr<MessageSink>> create_mcap_sink(const std::filesystem::path& path,
                                                      Compression compression, const std::string& profile,
                                                      const std::vector<std::filesystem::path>& kept_from);

/// A database as rosbag2 writes it (storage "sqlite3"). Messages keep their ids as long as these ascend.
Result<std::unique_ptr<MessageSink>> create_sqlite_sink(const std::filesystem::path& path);

}  // namespace sweepscope
