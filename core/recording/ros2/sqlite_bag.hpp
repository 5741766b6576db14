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

namespace sweepscope {

/// ROS 2 bags in SQLite databases (rosbag2's storage "sqlite3"): a table of topics and one of messages. The
/// database is opened for reading only, and nothing in it is run: its schema is not trusted. No file is made
/// or changed beside it; a write-ahead journal that its recorder left is read with it.
inline constexpr int kMaxSqliteMessage_bytes = 256 << 20;

struct SqliteTopic {
  std::string name;
  std::string type;      // for example sensor_msgs/msg/LaserScan
  std::string encoding;  // of its messages: "cdr"
  // What only some versions of ROS 2 record; else empty.
  std::string qos = {};              // offered_qos_profiles, as YAML
  std::string type_hash = {};        // type_description_hash
  std::string schema_encoding = {};  // "ros2msg" or another one
  std::string definition = {};       // of the type
};

/// One message. Its bytes and its topic are valid during the visit.
struct SqliteMessage {
  const SqliteTopic& topic;
  std::int64_t receive_ns;
  std::span<const std::byte> bytes;
  std::int64_t id;  // in the table of messages
};

/// Called with each topic, before all messages.
using SqliteTopicVisitor = std::function<void(const SqliteTopic&)>;
/// Called with every message in the order of the table; an error that it returns ends the reading.
using SqliteVisitor = std::function<std::optional<Error>(const SqliteMessage&)>;

/// Reads a whole bag. Returns warnings about what was damaged or missing. The intact part before the damage
/// is visited.
Result<std::vector<std::string>> read_sqlite_bag(const std::filesystem::path& path,
                                                 const SqliteVisitor& visit, const Job& job,
                                                 const SqliteTopicVisitor& visit_topic = {});

}  // namespace sweepscope
