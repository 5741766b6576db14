#pragma once

#include <rosbag/view.h>
#include <sqlite3.h>

#include <boost/crc.hpp>
#include <cstring>
#include <map>
#include <tuple>

#include "core/apply/apply.hpp"
#include "core/numbers.hpp"
#include "core/recording/streams/message_sink.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/folder_test.hpp"

/// What apply writes, read by others: rosbag, SQLite, and a reader of MCAP files that goes by their index.
namespace sweepscope::test {

namespace fs = std::filesystem;

/// A message with all that describes it.
struct Seen {
  std::string topic;
  std::int64_t receive_ns;
  std::string bytes;
  std::string description;

  auto key() const { return std::tie(topic, receive_ns, bytes, description); }
  bool operator==(const Seen& other) const { return key() == other.key(); }
};

/// But for the record of what was done.
inline std::vector<Seen> of_bag(const fs::path& path) {
  rosbag::Bag bag(path.string());
  rosbag::View view(bag);
  std::vector<Seen> all;
  for (const rosbag::MessageInstance& message : view) {
    if (message.getTopic() == kAppliedTopic) continue;
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    std::string description;
    for (const auto& [name, value] : *message.getConnectionHeader()) description += name + "=" + value + ";";
    all.push_back(
        {message.getTopic(), static_cast<std::int64_t>(message.getTime().toNSec()), bytes, description});
  }
  return all;
}

template <typename T>
T number(const std::string& bytes, std::size_t at) {
  T value{};
  EXPECT_LE(at + sizeof(T), bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

inline std::string text(const std::string& bytes, std::size_t& at) {
  const auto length = number<std::uint32_t>(bytes, at);
  at += 4 + length;
  return bytes.substr(at - length, length);
}

/// The records of a part of an MCAP file: operation, place, content.
inline std::vector<std::tuple<int, std::size_t, std::string>> mcap_records(const std::string& bytes,
                                                                           std::size_t at, std::size_t end) {
  std::vector<std::tuple<int, std::size_t, std::string>> records;
  while (at < end) {
    const auto length = number<std::uint64_t>(bytes, at + 1);
    records.emplace_back(static_cast<unsigned char>(bytes[at]), at, bytes.substr(at + 9, length));
    at += 9 + length;
  }
  return records;
}

/// Of a file whose chunks are not compressed: through the summary and the indexes of the chunks.
inline std::vector<Seen> of_mcap(const fs::path& path) {
  constexpr std::size_t kEnd_bytes = 9 + 20 + 8;
  const std::string bytes = contents_of(path);
  const std::size_t footer = bytes.size() - kEnd_bytes;
  std::map<int, std::string> channels, schemas;
  std::vector<Seen> all;
  for (const auto& [op, place, content] :
       mcap_records(bytes, number<std::uint64_t>(bytes, footer + 9), footer)) {
    if (op == 3) schemas[number<std::uint16_t>(content, 0)] = content.substr(2);
    if (op == 4) channels[number<std::uint16_t>(content, 0)] = content;
    if (op != 8) continue;
    const auto at = number<std::uint64_t>(content, 16), length = number<std::uint64_t>(content, 24);
    const std::string chunk = bytes.substr(at + 9, length - 9);
    EXPECT_EQ(bytes[at], 6);
    const std::string records = chunk.substr(8 + 8 + 8 + 4 + 4 + 8);
    boost::crc_32_type crc;
    crc.process_bytes(records.data(), records.size());
    EXPECT_EQ(crc.checksum(), number<std::uint32_t>(chunk, 24));
    std::map<std::uint64_t, std::uint64_t> indexed;  // the time by the place
    std::size_t places_at = 32;
    const std::string places = text(content, places_at);
    for (std::size_t i = 0; i < places.size(); i += 10) {
      const auto index_at = number<std::uint64_t>(places, i + 2);
      EXPECT_EQ(bytes[index_at], 7);
      const auto entries = number<std::uint32_t>(bytes, index_at + 9 + 2);
      for (std::size_t k = 0; k < entries; k += 16)
        indexed[number<std::uint64_t>(bytes, index_at + 15 + k + 8)] =
            number<std::uint64_t>(bytes, index_at + 15 + k);
    }
    for (const auto& [where, ns] : indexed) {
      const std::string message = records.substr(where + 9, number<std::uint64_t>(records, where + 1));
      EXPECT_EQ(number<std::uint64_t>(message, 6), ns);
      const std::string& channel = channels[number<std::uint16_t>(message, 0)];
      std::size_t topic_at = 4;
      const std::string topic = text(channel, topic_at);
      all.push_back({topic, static_cast<std::int64_t>(ns), message.substr(22),
                     channel.substr(4) + schemas[number<std::uint16_t>(channel, 2)]});
    }
  }
  return all;
}

inline std::vector<Seen> of_database(const fs::path& path) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  sqlite3_stmt* rows = nullptr;
  sqlite3_prepare_v2(
      database,
      "SELECT name, timestamp, data, type || serialization_format || offered_qos_profiles FROM "
      "messages JOIN topics ON topics.id = topic_id ORDER BY messages.id",
      -1, &rows, nullptr);
  const auto bytes = [&](int column) {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(rows, column));
    return std::string(data, data + sqlite3_column_bytes(rows, column));
  };
  std::vector<Seen> all;
  while (sqlite3_step(rows) == SQLITE_ROW)
    all.push_back({bytes(0), sqlite3_column_int64(rows, 1), bytes(2), bytes(3)});
  sqlite3_finalize(rows);
  sqlite3_close(database);
  return all;
}

/// The header's stamp of a message of ROS 1 or of little-endian CDR.
inline std::int64_t stamp_ns(const std::string& bytes) {
  return number<std::uint32_t>(bytes, 4) * kSecond_ns + number<std::uint32_t>(bytes, 8);
}

/// That the messages are the same but for the stamps of the moved ones.
inline void expect_moved(const std::vector<Seen>& before, const std::vector<Seen>& after, std::int64_t by_ns,
                         bool same_descriptions = true) {
  ASSERT_EQ(before.size(), after.size());
  std::size_t moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    Seen expected = before[i];
    if (!same_descriptions) expected.description = after[i].description;
    if (expected.topic == "/joint_states") {
      ++moved;
      ASSERT_EQ(stamp_ns(after[i].bytes) - stamp_ns(expected.bytes), by_ns);
      expected.bytes.replace(4, 8, after[i].bytes.substr(4, 8));
    }
    ASSERT_EQ(expected, after[i]) << i;
  }
  EXPECT_GT(moved, 0U);
}

class ApplyTest : public FolderTest {
 protected:
  Result<Applied> apply(const fs::path& recording, const std::string& output,
                        const ApplyOptions& options = at_24_ms()) const {
    return apply_offset(recording, folder_ / output, options, Job());
  }
  static ApplyOptions at_24_ms() {
    ApplyOptions options;
    options.offset.offset_s = 0.024;
    return options;
  }
};

}  // namespace sweepscope::test
