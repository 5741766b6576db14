#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <map>

#include "core/io/atomic_file.hpp"
#include "core/numbers.hpp"
#include "core/recording/messages/messages.hpp"
#include "core/recording/packed/compress.hpp"
#include "core/recording/ros1/ros1_record.hpp"
#include "core/recording/streams/message_sink.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kBagHeader_bytes = 4096;  // the record with its padding

template <typename T>
std::string as_bytes(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string counted(std::string_view bytes) {
  return as_bytes(static_cast<std::uint32_t>(bytes.size())).append(bytes);
}

std::string field(std::string_view name, std::string_view value) {
  return counted(std::string(name).append("=").append(value));
}

std::string op_field(BagOp op) {
  return field("op", as_bytes(static_cast<std::uint8_t>(op)));
}

/// Seconds and nanoseconds.
std::string bag_time(std::int64_t ns) {
  return as_bytes(static_cast<std::uint32_t>(ns / kSecond_ns)) +
         as_bytes(static_cast<std::uint32_t>(ns % kSecond_ns));
}

std::string bag_record(const std::string& header, std::string_view data) {
  return counted(header) + counted(data);
}

std::string_view name_in_bags(Compression compression) {
  if (compression == Compression::kBz2) return "bz2";
  return compression == Compression::kLz4 ? "lz4" : "none";
}

/// The connection header as recorded, or as rosbag would write it.
std::string connection_header(const StreamTopic& topic) {
  if (!topic.connection_header.empty()) return topic.connection_header;
  std::string md5sum = topic.metadata_of("md5sum");
  const MessageType* type = find_message_type(topic.type);
  if (md5sum.empty()) md5sum = type != nullptr ? type->md5 : "*";
  std::string header = field("topic", topic.name) + field("type", topic.type) + field("md5sum", md5sum) +
                       field("message_definition", topic.definition);
  for (const char* key : {"callerid", "latching"})
    if (const std::string value = topic.metadata_of(key); !value.empty()) header += field(key, value);
  return header;
}

class Ros1Sink : public MessageSink {
 public:
  Ros1Sink(AtomicFile file, Compression compression) : file_(std::move(file)), compression_(compression) {}

  Result<void> begin() { return write_bytes(std::string(kBagMagic) + bag_header(0)); }
  Result<void> add_topic(const StreamTopic& topic) override;
  Result<void> write(const StreamMessage& message) override;
  Result<void> finish(const std::vector<std::string>& records) override;

 private:
  struct IndexEntry {
    std::int64_t ns;
    std::uint32_t at;  // in the unpacked chunk
  };
  struct ChunkInfo {
    std::uint64_t at;
    std::int64_t first_ns, last_ns;
    std::string counts;  // of messages, per connection
    std::uint32_t connections;
  };
  std::string bag_header(std::uint64_t index_at) const;
  std::string connection_record(std::uint32_t number) const;
  Result<void> write_bytes(std::string_view bytes);
  Result<void> end_chunk();
  Result<void> write_bag_header(std::uint64_t index_at);
  Result<void> write_records(const std::vector<std::string>& records);

  AtomicFile file_;
  Compression compression_;
  std::uint64_t at_ = 0;
  std::vector<StreamTopic> topics_;
  std::vector<bool> described_;  // in a chunk
  std::string chunk_;
  std::map<std::uint32_t, std::vector<IndexEntry>> index_;  // of the chunk
  std::vector<ChunkInfo> chunks_;
  std::int64_t last_ns_ = 1;
};

std::string Ros1Sink::bag_header(std::uint64_t index_at) const {
  const std::string header =
      op_field(BagOp::kBagHeader) + field("index_pos", as_bytes(index_at)) +
      field("conn_count", as_bytes(static_cast<std::uint32_t>(index_at == 0 ? 0 : topics_.size()))) +
      field("chunk_count", as_bytes(static_cast<std::uint32_t>(index_at == 0 ? 0 : chunks_.size())));
  return bag_record(header, std::string(kBagHeader_bytes - header.size(), ' '));
}

std::string Ros1Sink::connection_record(std::uint32_t number) const {
  const StreamTopic& topic = topics_[number];
  return bag_record(
      op_field(BagOp::kConnection) + field("conn", as_bytes(number)) + field("topic", topic.name),
      connection_header(topic));
}

Result<void> Ros1Sink::write_bytes(std::string_view bytes) {
  at_ += bytes.size();
  return file_.write(bytes);
}

Result<void> Ros1Sink::add_topic(const StreamTopic& topic) {
  if (topic.encoding != "ros1")
    return failure(ExitCode::kWrongUsage,
                   file_
                       .error(fmt::format("a ROS 1 bag holds messages of ROS 1 only, and those on {} are "
                                          "encoded as {}; write OUT.mcap",
                                          topic.name, topic.encoding))
                       .message);
  topics_.push_back(topic);
  described_.push_back(false);
  return {};
}

Result<void> Ros1Sink::write(const StreamMessage& message) {
  const auto connection = static_cast<std::uint32_t>(message.topic);
  if (message.log_ns < 0 || message.log_ns / kSecond_ns > std::numeric_limits<std::uint32_t>::max())
    return tl::unexpected(
        file_.error(fmt::format("a ROS 1 bag holds no receive time {} s, of a message on {}",
                                message.log_ns / kSecond_ns, topics_[message.topic].name)));
  if (!described_[message.topic]) {
    chunk_ += connection_record(connection);
    described_[message.topic] = true;
  }
  last_ns_ = message.log_ns;
  index_[connection].push_back({message.log_ns, static_cast<std::uint32_t>(chunk_.size())});
  const std::string header = op_field(BagOp::kMessage) + field("conn", as_bytes(connection)) +
                             field("time", bag_time(message.log_ns));
  chunk_ += counted(header);
  chunk_ += as_bytes(static_cast<std::uint32_t>(message.bytes.size()));
  chunk_ += as_text(message.bytes);
  return chunk_.size() < kChunk_bytes ? Result<void>() : end_chunk();
}

/// Writes the chunk and the indexes of its messages.
Result<void> Ros1Sink::end_chunk() {
  if (chunk_.empty()) return {};
  ChunkInfo info{at_, std::numeric_limits<std::int64_t>::max(), 0, "", 0};
  const std::string header = op_field(BagOp::kChunk) + field("compression", name_in_bags(compression_)) +
                             field("size", as_bytes(static_cast<std::uint32_t>(chunk_.size())));
  const std::string packed =
      compression_ == Compression::kNone ? std::string() : compressed(compression_, chunk_);
  const std::string_view data = compression_ == Compression::kNone ? std::string_view(chunk_) : packed;
  auto written = write_bytes(counted(header)).and_then([&] {
    return write_bytes(as_bytes(static_cast<std::uint32_t>(data.size())));
  });
  if (written) written = write_bytes(data);
  if (!written) return written;
  for (auto& [connection, entries] : index_) {
    std::ranges::stable_sort(entries, {}, &IndexEntry::ns);  // readers search in it
    const auto count = static_cast<std::uint32_t>(entries.size());
    std::string places;
    for (const IndexEntry& entry : entries) places += bag_time(entry.ns) + as_bytes(entry.at);
    info.first_ns = std::min(info.first_ns, entries.front().ns);
    info.last_ns = std::max(info.last_ns, entries.back().ns);
    info.counts += as_bytes(connection) + as_bytes(count);
    ++info.connections;
    const std::string index_header = op_field(BagOp::kIndex) + field("ver", as_bytes(std::uint32_t{1})) +
                                     field("conn", as_bytes(connection)) + field("count", as_bytes(count));
    if (written = write_bytes(bag_record(index_header, places)); !written) return written;
  }
  chunks_.push_back(std::move(info));
  chunk_.clear();
  index_.clear();
  return {};
}

Result<void> Ros1Sink::write_records(const std::vector<std::string>& records) {
  if (records.empty()) return {};
  StreamTopic topic{kAppliedTopic, "std_msgs/String", "ros1", "ros1msg", "string data\n", "", {}};
  topic.metadata = {{"md5sum", "992ce8a1687cec8c8bd883ec73ca41d1"}, {"callerid", "/sweepscope"}};
  const std::size_t number = topics_.size();
  if (auto added = add_topic(topic); !added) return added;
  for (const std::string& record : records) {
    const std::string message = counted(record);
    auto written = write({number, last_ns_, last_ns_, 0, 0, compression_, std::as_bytes(std::span(message))});
    if (!written) return written;
  }
  return {};
}

/// The place of the index is known only at the end.
Result<void> Ros1Sink::write_bag_header(std::uint64_t index_at) {
  if (auto flushed = file_.flush(); !flushed) return flushed;
  const std::string header = bag_header(index_at);
  const int file = open(file_.part_path().c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return tl::unexpected(file_.error(std::strerror(errno)));
  const ssize_t done = pwrite(file, header.data(), header.size(), static_cast<off_t>(kBagMagic.size()));
  const int why = errno;
  close(file);
  if (done != static_cast<ssize_t>(header.size())) return tl::unexpected(file_.error(std::strerror(why)));
  return {};
}

Result<void> Ros1Sink::finish(const std::vector<std::string>& records) {
  if (auto written = write_records(records); !written) return written;
  if (auto ended = end_chunk(); !ended) return ended;
  const std::uint64_t index_at = at_;
  std::string index;
  for (std::uint32_t number = 0; number < topics_.size(); ++number) index += connection_record(number);
  for (const ChunkInfo& chunk : chunks_) {
    index += bag_record(
        op_field(BagOp::kChunkInfo) + field("ver", as_bytes(std::uint32_t{1})) +
            field("chunk_pos", as_bytes(chunk.at)) + field("start_time", bag_time(chunk.first_ns)) +
            field("end_time", bag_time(chunk.last_ns)) + field("count", as_bytes(chunk.connections)),
        chunk.counts);
  }
  return write_bytes(index).and_then([&] { return write_bag_header(index_at); }).and_then([&] {
    return file_.commit();
  });
}

}  // namespace

Result<std::unique_ptr<MessageSink>> create_ros1_sink(const std::filesystem::path& path,
                                                      Compression compression) {
  auto file = AtomicFile::create_seekable(path);
  if (!file) return tl::unexpected(file.error());
  auto sink = std::make_unique<Ros1Sink>(std::move(*file), compression);
  if (const auto begun = sink->begin(); !begun) return tl::unexpected(begun.error());
  return sink;
}

}  // namespace sweepscope
