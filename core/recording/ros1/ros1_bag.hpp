#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/packed/decompress.hpp"

namespace sweepscope {

/// ROS 1 bags, format 2.0 (http://wiki.ros.org/Bags/Format/2.0), read record by record from the front. The
/// index at the end is not needed, so bags that were cut short or never closed read like any other. Behind a
/// damaged part reading goes on at the next record. No size in the file is trusted: the size of a record is
/// checked against the rest of the file, against the places of chunks in the index, and against these limits.
inline constexpr std::uint64_t kMaxChunk_bytes = std::uint64_t{256} << 20;  // packed or unpacked
inline constexpr std::uint64_t kMaxHeader_bytes = std::uint64_t{1} << 20;

/// One publisher of a topic. Several connections may share a topic.
struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;  // for example sensor_msgs/LaserScan
  std::string md5sum;
  std::string header;  // as recorded: fields of type, md5sum, message_definition, callerid and others
};

/// One message. Its bytes and its connection are valid during the visit.
struct BagMessage {
  const BagConnection& connection;
  std::int64_t receive_ns;
  std::span<const std::byte> bytes;
  BagPlace place;
  Compression compression;  // of its chunk
};

/// Called with each connection, before its first message, and again where the bag describes it otherwise.
using BagConnectionVisitor = std::function<void(const BagConnection&)>;
/// Called with every message in the file's order; an error that it returns ends the reading.
using BagVisitor = std::function<std::optional<Error>(const BagMessage&)>;

/// Reads a whole bag, one chunk in memory at a time. Returns warnings about what was damaged or missing, each
/// with its position. The intact part of a damaged bag is visited.
Result<std::vector<std::string>> read_ros1_bag(const std::filesystem::path& path, const BagVisitor& visit,
                                               const Job& job,
                                               const BagConnectionVisitor& visit_connection = {});

}  // namespace sweepscope
