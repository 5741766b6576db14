#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/packed/unpacking_limit.hpp"

namespace sweepscope {

/// MCAP files (https://mcap.dev/spec), read record by record from the front. Indexes, statistics and the
/// footer are not needed, so files that were cut short or never closed read like any other; if there is a
/// summary, its channels help to read messages whose channel was in a damaged chunk. No size in the file is
/// trusted: the size of a record is checked against the rest of the file and against these limits.
inline constexpr std::uint64_t kMaxMcapChunk_bytes = std::uint64_t{256} << 20;  // packed or unpacked
inline constexpr std::uint64_t kMaxMcapSummary_bytes = std::uint64_t{16} << 20;

struct McapChannel {
  std::string topic;
  std::string encoding;         // of its messages: "cdr", "ros1" or another one
  std::string type;             // its schema's name, for example sensor_msgs/msg/LaserScan
  std::string md5sum = "*";     // if a converter kept it from ROS 1
  std::string schema_encoding;  // "ros1msg", "ros2msg" or another one; empty where there is no schema
  std::string definition;       // what the schema holds
  std::vector<std::pair<std::string, std::string>> metadata;  // as recorded

  bool operator==(const McapChannel&) const = default;
};

/// One message. Its bytes and its channel are valid during the visit.
struct McapMessage {
  const McapChannel& channel;
  std::int64_t log_ns;
  std::span<const std::byte> bytes;
  BagPlace place;
  std::uint32_t sequence;
  std::int64_t publish_ns;
  Compression compression;  // of its chunk
};

/// Called with each channel, before its first message, and again where the file describes it otherwise.
using McapChannelVisitor = std::function<void(const McapChannel&)>;
/// Called with every message in the file's order; an error that it returns ends the reading.
using McapVisitor = std::function<std::optional<Error>(const McapMessage&)>;

/// Reads a whole file, one chunk in memory at a time. Returns warnings about what was damaged or missing,
/// each with its position. The intact part of a damaged file is visited; a chunk whose checksum is wrong is
/// not.
Result<std::vector<std::string>> read_mcap(const std::filesystem::path& path, const McapVisitor& visit,
                                           const Job& job);
/// The same for a file that was itself unpacked, with the limit of the packed one.
Result<std::vector<std::string>> read_mcap(const std::filesystem::path& path, UnpackingLimit& limit,
                                           const McapVisitor& visit, const Job& job,
                                           const McapChannelVisitor& visit_channel = {});

}  // namespace sweepscope
