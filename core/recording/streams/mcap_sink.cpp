#include <algorithm>
#include <limits>
#include <map>

#include "core/io/atomic_file.hpp"
#include "core/recording/packed/compress.hpp"
#include "core/recording/ros2/mcap_extras.hpp"
#include "core/recording/ros2/mcap_records.hpp"
#include "core/recording/streams/message_sink.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// The content of a record, little-endian.
class McapContent {
 public:
  template <typename T>
  McapContent& number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  McapContent& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

McapContent metadata_map(const std::vector<std::pair<std::string, std::string>>& entries) {
  McapContent map;
  for (const auto& [name, value] : entries) map.text(name).text(value);
  return map;
}

/// The beginning of a record whose content is `bytes` long.
std::string record_header(McapOp op, std::uint64_t bytes) {
  return McapContent().number(static_cast<std::uint8_t>(op)).number(bytes).bytes();
}

std::string mcap_record(McapOp op, const McapContent& content) {
  return record_header(op, content.bytes().size()) + content.bytes();
}

std::uint64_t unsigned_ns(std::int64_t ns) {
  return ns < 0 ? 0 : static_cast<std::uint64_t>(ns);
}

/// Messages are in chunks with checksums and indexes; a summary has the schemas, channels, statistics and
/// places of all else (https://mcap.dev/spec).
class McapSink : public MessageSink {
 public:
  McapSink(AtomicFile file, Compression compression) : file_(std::move(file)), compression_(compression) {}

  Result<void> begin(std::string_view profile);
  Result<void> add_topic(const StreamTopic& topic) override;
  Result<void> write(const StreamMessage& message) override;
  Result<void> finish(const std::vector<std::string>& records) override;
  /// An attachment, metadata or a private record of another file, as it is there.
  Result<void> copy(const fs::path& from, const McapExtra& extra);

 private:
  struct IndexEntry {
    std::uint64_t ns, at;  // in the unpacked chunk
  };
  struct Schema {
    std::string name, encoding, definition;
    bool operator==(const Schema&) const = default;
  };
  /// The times of messages.
  struct TimeSpan {
    std::uint64_t first_ns = UINT64_MAX, last_ns = 0;

    void add(std::uint64_t ns) {
      first_ns = std::min(first_ns, ns);
      last_ns = std::max(last_ns, ns);
    }
    std::uint64_t start_ns() const { return std::min(first_ns, last_ns); }
  };

  Result<void> put(std::string_view bytes);
  std::uint16_t schema_of(const StreamTopic& topic);
  void note_metadata(std::uint64_t bytes, std::string_view name);
  Result<void> write_record(const std::string& record);
  std::string message_indexes(std::string& places);
  Result<void> end_chunk();
  std::string statistics() const;
  std::string summary() const;

  AtomicFile file_;
  Compression compression_;
  std::uint64_t at_ = 0;  // the bytes written so far
  std::string schema_records_, channel_records_;
  std::vector<Schema> schemas_;
  std::vector<std::uint64_t> counts_;  // of messages, by channel
  std::string chunk_;
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;  // of the chunk, by channel
  TimeSpan chunk_times_, times_;
  std::string chunk_indexes_, attachment_indexes_, metadata_indexes_;
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;
};

Result<void> McapSink::begin(std::string_view profile) {
  const std::string header =
      mcap_record(McapOp::kHeader, McapContent().text(profile).text("sweepscope " SWEEPSCOPE_VERSION));
  return put(std::string(kMcapMagic) + header);
}

Result<void> McapSink::put(std::string_view bytes) {
  at_ += bytes.size();
  return file_.write(bytes);
}

/// The number of the channel's schema, which may have been described for another one; 0: it has none.
std::uint16_t McapSink::schema_of(const StreamTopic& topic) {
  if (topic.type.empty()) return 0;
  const Schema schema{topic.type, topic.schema_encoding, topic.definition};
  const auto known = std::ranges::find(schemas_, schema);
  const auto number = static_cast<std::uint16_t>(known - schemas_.begin() + 1);
  if (known != schemas_.end()) return number;
  schemas_.push_back(schema);
  const std::string record = mcap_record(
      McapOp::kSchema,
      McapContent().number(number).text(schema.name).text(schema.encoding).text(schema.definition));
  schema_records_ += record;
  chunk_ += record;
  return number;
}

Result<void> McapSink::add_topic(const StreamTopic& topic) {
  if (counts_.size() >= std::numeric_limits<std::uint16_t>::max())
    return tl::unexpected(file_.error("an MCAP file holds no more than 65535 channels"));
  const std::uint16_t schema = schema_of(topic);
  const std::string record =
      mcap_record(McapOp::kChannel, McapContent()
                                        .number(static_cast<std::uint16_t>(counts_.size()))
                                        .number(schema)
                                        .text(topic.name)
                                        .text(topic.encoding)
                                        .text(metadata_map(topic.metadata).bytes()));
  channel_records_ += record;
  chunk_ += record;
  counts_.push_back(0);
  return {};
}

Result<void> McapSink::write(const StreamMessage& message) {
  const auto channel = static_cast<std::uint16_t>(message.topic);
  const std::uint64_t log_ns = unsigned_ns(message.log_ns);
  index_[channel].push_back({log_ns, chunk_.size()});
  chunk_times_.add(log_ns);
  times_.add(log_ns);
  ++counts_[channel];
  McapContent fields;
  fields.number(channel).number(message.sequence).number(log_ns).number(unsigned_ns(message.publish_ns));
  chunk_ += record_header(McapOp::kMessage, fields.bytes().size() + message.bytes.size());
  chunk_ += fields.bytes();
  chunk_.append(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size());
  return chunk_.size() < kChunk_bytes ? Result<void>() : end_chunk();
}

void McapSink::note_metadata(std::uint64_t bytes, std::string_view name) {
  metadata_indexes_ +=
      mcap_record(McapOp::kMetadataIndex, McapContent().number(at_).number(bytes).text(name));
  ++metadata_;
}

Result<void> McapSink::write_record(const std::string& record) {
  if (auto ended = end_chunk(); !ended) return ended;
  const std::string metadata =
      mcap_record(McapOp::kMetadata,
                  McapContent().text(kAppliedMetadata).text(metadata_map({{"record", record}}).bytes()));
  note_metadata(metadata.size(), kAppliedMetadata);
  return put(metadata);
}

Result<void> McapSink::copy(const fs::path& from, const McapExtra& extra) {
  constexpr std::uint64_t kMostHead_bytes = std::uint64_t{64} << 10;  // of an attachment: before its data
  if (auto ended = end_chunk(); !ended) return ended;
  std::string beginning;
  const auto read = read_mcap_extra(from, extra, kMostHead_bytes, [&](std::string_view block) {
    beginning += block;
    return Result<void>();
  });
  if (!read) return read;
  McapFields fields(std::as_bytes(std::span(beginning)));
  const std::uint64_t length = kMcapRecordHeader_bytes + extra.bytes;
  if (extra.op == McapOp::kMetadata) note_metadata(length, fields.text());
  if (extra.op == McapOp::kAttachment) {
    const auto log_ns = fields.number<std::uint64_t>(), create_ns = fields.number<std::uint64_t>();
    const std::string_view name = fields.text(), media_type = fields.text();
    McapContent index;
    index.number(at_).number(length).number(log_ns).number(create_ns);
    index.number(fields.number<std::uint64_t>()).text(name).text(media_type);
    attachment_indexes_ += mcap_record(McapOp::kAttachmentIndex, index);
    ++attachments_;
  }
  if (auto written = put(record_header(extra.op, extra.bytes)); !written) return written;
  return read_mcap_extra(from, extra, extra.bytes, [&](std::string_view block) { return put(block); });
}

/// The indexes of the chunk's messages, written from here on; `places` gets where each of them is.
std::string McapSink::message_indexes(std::string& places) {
  std::string indexes;
  McapContent offsets;
  for (auto& [channel, entries] : index_) {
    std::ranges::stable_sort(entries, {}, &IndexEntry::ns);  // readers may search in it
    McapContent content;
    for (const IndexEntry& entry : entries) content.number(entry.ns).number(entry.at);
    offsets.number(channel).number(at_ + indexes.size());
    indexes += mcap_record(McapOp::kMessageIndex, McapContent().number(channel).text(content.bytes()));
  }
  places = offsets.bytes();
  index_.clear();
  return indexes;
}

/// Writes the chunk, if there is one, and the indexes of its messages.
Result<void> McapSink::end_chunk() {
  if (chunk_.empty()) return {};
  const std::uint64_t chunk_at = at_;
  const bool plain = compression_ == Compression::kNone;
  const std::string packed = plain ? std::string() : compressed(compression_, chunk_);
  const std::string_view records = plain ? std::string_view(chunk_) : packed;
  McapContent fields;
  fields.number(chunk_times_.start_ns()).number(chunk_times_.last_ns).number(std::uint64_t{chunk_.size()});
  fields.number(crc32_of(std::as_bytes(std::span(chunk_)))).text(mcap_name(compression_));
  fields.number(std::uint64_t{records.size()});
  auto written = put(record_header(McapOp::kChunk, fields.bytes().size() + records.size()) + fields.bytes());
  if (written) written = put(records);
  if (!written) return written;
  const std::uint64_t chunk_bytes = at_ - chunk_at;
  std::string places;
  const std::string indexes = message_indexes(places);
  McapContent index;
  index.number(chunk_times_.start_ns()).number(chunk_times_.last_ns).number(chunk_at).number(chunk_bytes);
  index.text(places).number(std::uint64_t{indexes.size()}).text(mcap_name(compression_));
  index.number(std::uint64_t{records.size()}).number(std::uint64_t{chunk_.size()});
  chunk_indexes_ += mcap_record(McapOp::kChunkIndex, index);
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
  return put(indexes);
}

std::string McapSink::statistics() const {
  McapContent counts;
  std::uint64_t messages = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] > 0) counts.number(static_cast<std::uint16_t>(i)).number(counts_[i]);
    messages += counts_[i];
  }
  return mcap_record(McapOp::kStatistics, McapContent()
                                              .number(messages)
                                              .number(static_cast<std::uint16_t>(schemas_.size()))
                                              .number(static_cast<std::uint32_t>(counts_.size()))
                                              .number(attachments_)
                                              .number(metadata_)
                                              .number(chunks_)
                                              .number(times_.start_ns())
                                              .number(times_.last_ns)
                                              .text(counts.bytes()));
}

/// The groups of the summary, which begins here, the places of the groups, and the footer.
std::string McapSink::summary() const {
  std::string groups, places;
  const auto add = [&](McapOp op, const std::string& records) {
    if (records.empty()) return;
    places += mcap_record(McapOp::kSummaryOffset, McapContent()
                                                      .number(static_cast<std::uint8_t>(op))
                                                      .number(at_ + groups.size())
                                                      .number(std::uint64_t{records.size()}));
    groups += records;
  };
  add(McapOp::kSchema, schema_records_);
  add(McapOp::kChannel, channel_records_);
  add(McapOp::kStatistics, statistics());
  add(McapOp::kChunkIndex, chunk_indexes_);
  add(McapOp::kAttachmentIndex, attachment_indexes_);
  add(McapOp::kMetadataIndex, metadata_indexes_);
  McapContent footer;  // the summary has no checksum
  footer.number(at_).number(at_ + groups.size()).number(std::uint32_t{0});
  return groups + places + mcap_record(McapOp::kFooter, footer);
}

Result<void> McapSink::finish(const std::vector<std::string>& records) {
  for (const std::string& record : records)
    if (auto written = write_record(record); !written) return written;
  return end_chunk()
      .and_then([&] { return put(mcap_record(McapOp::kDataEnd, McapContent().number(std::uint32_t{0}))); })
      .and_then([&] { return put(summary()); })
      .and_then([&] { return put(kMcapMagic); })
      .and_then([&] { return file_.commit(); });
}

}  // namespace

Result<std::unique_ptr<MessageSink>> create_mcap_sink(const fs::path& path, Compression compression,
                                                      const std::string& profile,
                                                      const std::vector<fs::path>& kept_from) {
  std::vector<McapExtras> all;
  for (const fs::path& kept : kept_from) {
    auto extras = find_mcap_extras(kept);
    if (!extras) return tl::unexpected(extras.error());
    all.push_back(std::move(*extras));
  }
  auto file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  auto sink = std::make_unique<McapSink>(std::move(*file), compression);
  if (auto begun = sink->begin(all.empty() ? profile : all.front().profile); !begun)
    return tl::unexpected(begun.error());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const McapExtra& extra : all[i].records)
      if (auto copied = sink->copy(kept_from[i], extra); !copied) return tl::unexpected(copied.error());
  return sink;
}

}  // namespace sweepscope
