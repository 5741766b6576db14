#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/messages/message_topic.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/packed/unpacked_file.hpp"
#include "core/recording/packed/unpacking_limit.hpp"
#include "core/recording/ros2/bag_files.hpp"

namespace sweepscope {

/// A recording as a stream of serialised messages, with all that is needed to write each of them unchanged,
/// in the same format or in another one.

using StreamFormat = BagStorage;

struct StreamFile {
  std::filesystem::path path;
  StreamFormat format = StreamFormat::kRos1;
  std::shared_ptr<const UnpackedFile> plain = nullptr;  // if the file is compressed as a whole (Zstandard)

  /// The file to read.
  const std::filesystem::path& readable() const { return plain ? plain->path() : path; }
};

struct StreamRecording {
  std::filesystem::path path;
  bool is_folder = false;         // of a bag
  std::vector<StreamFile> files;  // at least one
};

/// Opens a file; the format is detected from the content. A file that is compressed as a whole is
/// decompressed into the folder for temporary files, which counts towards `limit`.
Result<StreamFile> open_stream_file(const std::filesystem::path& path, UnpackingLimit& limit, const Job& job);
/// Opens all files of a recording. A folder of CSV tables, which has no messages, is ExitCode::kWrongUsage.
Result<StreamRecording> open_stream(const std::filesystem::path& path, const Job& job);

/// A connection of a ROS 1 bag, a channel of an MCAP file or a topic of a database.
struct StreamTopic {
  std::string name;
  std::string type;             // in the format's spelling: sensor_msgs/LaserScan, sensor_msgs/msg/LaserScan
  std::string encoding;         // of the messages: "ros1", "cdr" or another one
  std::string schema_encoding;  // of the definition: "ros1msg", "ros2msg" or another one
  std::string definition;       // of the type; may be empty
  std::string connection_header;  // of a ROS 1 bag, as recorded; else empty
  /// In the form of an MCAP channel's: md5sum, callerid, latching; offered_qos_profiles, topic_type_hash.
  std::vector<std::pair<std::string, std::string>> metadata;

  bool operator==(const StreamTopic&) const = default;
  /// Empty if there is none.
  std::string metadata_of(std::string_view key) const;
};

/// The same for reading its messages; not decodable where their encoding is neither "cdr" nor "ros1".
MessageTopic message_topic(const StreamTopic& topic);

/// A topic of a type that sweepscope writes (message_definition), which is in ROS 1's spelling.
StreamTopic written_topic(const std::string& name, std::string_view type, Encoding encoding);

struct StreamMessage {
  std::size_t topic = 0;  // the number returned by StreamVisitor::topic
  std::int64_t log_ns = 0, publish_ns = 0;
  std::uint32_t sequence = 0;
  std::int64_t id = 0;  // in a database; else 0
  Compression compression = Compression::kNone;
  std::span<const std::byte> bytes;
  BagPlace place = {};  // not in a database
};

struct StreamVisitor {
  /// Called with every topic before its first message; an error that it returns ends the reading.
  std::function<std::size_t(const StreamTopic&)> topic;
  std::function<std::optional<Error>(const StreamMessage&)> message;
};

/// Reads one file from its first message to its last, with one chunk in memory at a time. Returns warnings
/// about damaged or missing parts. The intact part of a damaged file is visited. What chunks unpack to counts
/// towards `limit`.
Result<std::vector<std::string>> read_stream(const StreamFile& file, UnpackingLimit& limit,
                                             const StreamVisitor& visitor, const Job& job);
Result<std::vector<std::string>> read_stream(const StreamFile& file, const StreamVisitor& visitor,
                                             const Job& job);

}  // namespace sweepscope
