#include "core/recording/streams/message_stream.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "core/io/input_file.hpp"
#include "core/recording/csv/csv_recording.hpp"
#include "core/recording/messages/message_definitions.hpp"
#include "core/recording/ros1/ros1_bag.hpp"
#include "core/recording/ros1/ros1_record.hpp"
#include "core/recording/ros2/mcap_file.hpp"
#include "core/recording/ros2/sqlite_bag.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

StreamTopic topic_of(const BagConnection& connection) {
  StreamTopic topic{connection.topic, connection.type, "ros1", "ros1msg", "", connection.header, {}};
  const auto fields = BagFields::parse(std::as_bytes(std::span(connection.header)));
  if (!fields) return topic;
  topic.definition = fields->text("message_definition").value_or("");
  for (const char* key : {"md5sum", "callerid", "latching"})
    if (const auto value = fields->text(key)) topic.metadata.emplace_back(key, *value);
  return topic;
}

StreamTopic topic_of(const McapChannel& channel) {
  return {channel.topic,      channel.type, channel.encoding, channel.schema_encoding,
          channel.definition, "",           channel.metadata};
}

StreamTopic topic_of(const SqliteTopic& topic) {
  StreamTopic same{topic.name, topic.type, topic.encoding, topic.schema_encoding, topic.definition, "", {}};
  if (!topic.qos.empty()) same.metadata.emplace_back("offered_qos_profiles", topic.qos);
  if (!topic.type_hash.empty()) same.metadata.emplace_back("topic_type_hash", topic.type_hash);
  return same;
}

/// The numbers of the topics, by the address of their description in the reader.
template <typename Described>
class Numbers {
 public:
  explicit Numbers(const StreamVisitor& visitor) : visitor_(visitor) {}

  auto describe() {
    return [this](const Described& described) { numbers_[&described] = visitor_.topic(topic_of(described)); };
  }
  std::size_t of(const Described& described) const { return numbers_.at(&described); }

 private:
  const StreamVisitor& visitor_;
  std::map<const Described*, std::size_t> numbers_;
};

Result<std::vector<std::string>> read_bag(const fs::path& path, const StreamVisitor& visitor,
                                          const Job& job) {
  Numbers<BagConnection> numbers(visitor);
  const auto visit = [&](const BagMessage& m) {
    return visitor.message(
        {numbers.of(m.connection), m.receive_ns, m.receive_ns, 0, 0, m.compression, m.bytes, m.place});
  };
  return read_ros1_bag(path, visit, job, numbers.describe());
}

Result<std::vector<std::string>> read_mcap_file(const fs::path& path, UnpackingLimit& limit,
                                                const StreamVisitor& visitor, const Job& job) {
  Numbers<McapChannel> numbers(visitor);
  const auto visit = [&](const McapMessage& m) {
    return visitor.message(
        {numbers.of(m.channel), m.log_ns, m.publish_ns, m.sequence, 0, m.compression, m.bytes, m.place});
  };
  return read_mcap(path, limit, visit, job, numbers.describe());
}

Result<std::vector<std::string>> read_database(const fs::path& path, const StreamVisitor& visitor,
                                               const Job& job) {
  Numbers<SqliteTopic> numbers(visitor);
  const auto visit = [&](const SqliteMessage& m) {
    return visitor.message(
        {numbers.of(m.topic), m.receive_ns, m.receive_ns, 0, m.id, Compression::kNone, m.bytes});
  };
  return read_sqlite_bag(path, visit, job, numbers.describe());
}

/// What a sentence says of `file`, said of `other`.
std::string renamed(std::string sentence, const fs::path& file, const fs::path& other) {
  const std::string name = file.string();
  for (std::size_t at = 0; (at = sentence.find(name, at)) != std::string::npos; at += other.string().size())
    sentence.replace(at, name.size(), other.string());
  return sentence;
}

}  // namespace

std::string StreamTopic::metadata_of(std::string_view key) const {
  for (const auto& [known, value] : metadata)
    if (known == key) return value;
  return "";
}

MessageTopic message_topic(const StreamTopic& topic) {
  const bool ros1 = topic.encoding == "ros1", cdr = topic.encoding == "cdr";
  MessageTopic same{topic.name, topic.type, cdr ? Encoding::kCdr : Encoding::kRos1, ros1 || cdr};
  if (std::string md5sum = ros1 ? topic.metadata_of("md5sum") : ""; !md5sum.empty())
    same.md5sum = std::move(md5sum);
  if (topic.schema_encoding == "ros1msg" || topic.schema_encoding == "ros2msg")
    same.definition = topic.definition;
  return same;
}

StreamTopic written_topic(const std::string& name, std::string_view type, Encoding encoding) {
  StreamTopic topic{name, std::string(type), "ros1", "ros1msg", message_definition(type, encoding), "", {}};
  if (encoding == Encoding::kRos1) {
    topic.metadata.emplace_back("md5sum", find_message_type(type)->md5);
    return topic;
  }
  topic.type.insert(type.find('/'), "/msg");
  topic.encoding = "cdr";
  topic.schema_encoding = "ros2msg";
  return topic;
}

Result<StreamFile> open_stream_file(const fs::path& path, UnpackingLimit& limit, const Job& job) {
  if (const auto file = InputFile::open(path); !file) return tl::unexpected(file.error());
  const auto stored = stored_as(path);
  if (!stored)
    return unreadable(
        fmt::format("{}: byte 0 begins neither a ROS 1 bag of format 2.0, nor an MCAP file, nor the database "
                    "of a ROS 2 bag, nor one of these packed by zstd",
                    path.string()));
  StreamFile opened{path, stored->storage};
  if (!stored->packed) return opened;
  auto plain = UnpackedFile::unpack(path, limit, job);
  if (!plain) return tl::unexpected(plain.error());
  opened.plain = std::make_shared<const UnpackedFile>(std::move(*plain));
  return opened;
}

Result<StreamRecording> open_stream(const fs::path& path, const Job& job) {
  std::error_code ignored;
  StreamRecording recording{path, fs::is_directory(path, ignored), {}};
  std::vector<fs::path> files{path};
  if (recording.is_folder) {
    if (!is_bag_folder(path)) {
      const bool csv = fs::exists(path / kScansCsv, ignored);
      return failure(
          csv ? ExitCode::kWrongUsage : ExitCode::kUnreadableInput,
          fmt::format("{}: {}", path.string(),
                      csv ? "is a folder of CSV tables, which have no messages; subtract the offset "
                            "from the stamps of motor.csv"
                          : "is a folder without a bag"));
    }
    auto found = bag_files_of(path);
    if (!found) return tl::unexpected(found.error());
    files = std::move(*found);
  }
  for (const fs::path& name : files) {
    UnpackingLimit limit(name);
    auto file = open_stream_file(name, limit, job);
    if (!file) return tl::unexpected(file.error());
    recording.files.push_back(std::move(*file));
  }
  return recording;
}

Result<std::vector<std::string>> read_stream(const StreamFile& file, UnpackingLimit& limit,
                                             const StreamVisitor& visitor, const Job& job) {
  const fs::path& path = file.readable();
  if (file.format == StreamFormat::kRos1) return read_bag(path, visitor, job);
  auto damage = file.format == StreamFormat::kMcap ? read_mcap_file(path, limit, visitor, job)
                                                   : read_database(path, visitor, job);
  if (!file.plain) return damage;
  if (!damage) return failure(damage.error().code, renamed(damage.error().message, path, file.path));
  for (std::string& what : *damage) what = renamed(what, path, file.path);
  if (!file.plain->problem().empty()) damage->push_back(file.plain->problem());
  return damage;
}

Result<std::vector<std::string>> read_stream(const StreamFile& file, const StreamVisitor& visitor,
                                             const Job& job) {
  UnpackingLimit limit(file.readable());
  return read_stream(file, limit, visitor, job);
}

}  // namespace sweepscope
