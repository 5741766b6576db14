#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/apply/mcap_extras.hpp"
#include "core/apply/message_sink.hpp"
#include "core/apply/provenance.hpp"
#include "core/io/atomic_file.hpp"
#include "core/recording/packed/compress.hpp"
#include "core/recording/ros1/ros1_record.hpp"
#include "core/recording/ros2/mcap_content.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk_bytes = std::size_t{768} << 10;

std::string name_in_mcap(Compression compression) {
  if (compression == Compression::kLz4) return "lz4";
  return compression == Compression::kZstd ? "zstd" : "";
}

std::uint64_t unsigned_ns(std::int64_t ns) {
  return ns < 0 ? 0 : static_cast<std::uint64_t>(ns);
}

McapContent metadata_map(const std::vector<std::pair<std::string, std::string>>& entries) {
  McapContent map;
  for (const auto& [name, value] : entries) map.text(name).text(value);
  return map;
}

/// The times of messages.
struct TimeSpan {
  std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max(), last_ns = 0;

  void add(std::uint64_t ns) {
    first_ns = std::min(first_ns, ns);
    last_ns = std::max(last_ns, ns);
  }
  std::uint64_t start_ns() const { return std::min(first_ns, last_ns); }
};

class McapSink : public MessageSink {
 public:
  McapSink(AtomicFile file, Compression compression) : file_(std::move(file)), compression_(compression) {}

  Result<void> begin(const std::string& profile, const std::vector<fs::path>& kept_from);
  Result<void> add_topic(const StreamTopic& topic) override;
  Result<void> write(const StreamMessage& message) override;
  Result<void> finish(const std::vector<std::string>& records) override;

 private:
  struct IndexEntry {
    std::uint64_t ns, at;  // in the unpacked chunk
  };
  Result<void> write_bytes(std::string_view bytes);
  Result<void> keep(const fs::path& path, const McapExtra& extra);
  std::uint16_t schema_of(const StreamTopic& topic);
  std::string message_indexes(std::uint64_t at, std::string& places);
  Result<void> end_chunk();
  std::string summary(std::uint64_t summary_at) const;
  std::string statistics() const;

  AtomicFile file_;
  Compression compression_;
  std::uint64_t at_ = 0;
  std::string schemas_, channels_;      // the records
  std::vector<StreamTopic> described_;  // a topic for each schema
  std::vector<std::uint64_t> counts_;
  std::string chunk_;
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;
  TimeSpan chunk_times_, times_;
  std::string chunk_indexes_, attachment_indexes_, metadata_indexes_;
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;
};

Result<void> McapSink::write_bytes(std::string_view bytes) {
  at_ += bytes.size();
  return file_.write(bytes);
}

Result<void> McapSink::begin(const std::string& profile, const std::vector<fs::path>& kept_from) {
  std::vector<McapExtras> all;
  for (const fs::path& path : kept_from) {
    auto extras = find_mcap_extras(path);
    if (!extras) return tl::unexpected(extras.error());
    all.push_back(std::move(*extras));
  }
  const std::string& kept_profile = all.empty() ? profile : all.front().profile;
  auto written = write_bytes(
      std::string(kMcapMagic) +
      mcap_record(McapOp::kHeader, McapContent().text(kept_profile).text("sweepscope " SWEEPSCOPE_VERSION)));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const McapExtra& extra : all[i].records)
      if (written && !(written = keep(kept_from[i], extra))) return written;
  return written;
}

/// Copies an attachment, metadata or a private record, and notes it for the summary.
Result<void> McapSink::keep(const fs::path& path, const McapExtra& extra) {
  constexpr std::uint64_t kBeginning_bytes = std::uint64_t{64} << 10;  // of an attachment: before its data
  const std::uint64_t at = at_, length = kMcapRecordHeader_bytes + extra.bytes;
  std::string beginning;
  const auto read = read_mcap_extra(path, extra, kBeginning_bytes, [&](std::string_view block) {
    beginning += block;
    return Result<void>();
  });
  if (!read) return read;
  McapFields fields(std::as_bytes(std::span(beginning)));
  if (extra.op == McapOp::kAttachment) {
    const auto log_ns = fields.number<std::uint64_t>(), create_ns = fields.number<std::uint64_t>();
    const std::string_view name = fields.text(), media_type = fields.text();
    McapContent index;
    index.number(at).number(length).number(log_ns).number(create_ns);
    index.number(fields.number<std::uint64_t>()).text(name).text(media_type);
    attachment_indexes_ += mcap_record(McapOp::kAttachmentIndex, index);
    ++attachments_;
  } else if (extra.op == McapOp::kMetadata) {
    metadata_indexes_ +=
        mcap_record(McapOp::kMetadataIndex, McapContent().number(at).number(length).text(fields.text()));
    ++metadata_;
  }
  const std::string header =
      std::string(1, static_cast<char>(extra.op)) + McapContent().number(extra.bytes).bytes();
  if (auto written = write_bytes(header); !written) return written;
  return read_mcap_extra(path, extra, extra.bytes,
                         [&](std::string_view block) { return write_bytes(block); });
}

/// The number of the topic's schema, which may have been described for another one; 0: it has none.
std::uint16_t McapSink::schema_of(const StreamTopic& topic) {
  if (topic.type.empty()) return 0;
  const auto same = [&](const StreamTopic& other) {
    return other.type == topic.type && other.schema_encoding == topic.schema_encoding &&
           other.definition == topic.definition;
  };
  const auto known = std::ranges::find_if(described_, same);
  const auto number = static_cast<std::uint16_t>(known - described_.begin() + 1);
  if (known != described_.end()) return number;
  described_.push_back(topic);
  const std::string record = mcap_record(
      McapOp::kSchema,
      McapContent().number(number).text(topic.type).text(topic.schema_encoding).text(topic.definition));
  schemas_ += record;
  chunk_ += record;
  return number;
}

Result<void> McapSink::add_topic(const StreamTopic& topic) {
  if (counts_.size() >= std::numeric_limits<std::uint16_t>::max())
    return tl::unexpected(file_.error("an MCAP file holds no more than 65535 channels"));
  const std::uint16_t schema = schema_of(topic);
  const auto number = static_cast<std::uint16_t>(counts_.size());
  const std::string record = mcap_record(McapOp::kChannel, McapContent()
                                                               .number(number)
                                                               .number(schema)
                                                               .text(topic.name)
                                                               .text(topic.encoding)
                                                               .text(metadata_map(topic.metadata).bytes()));
  channels_ += record;
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
  ++counts_[message.topic];
  McapContent header;
  header.number(static_cast<std::uint8_t>(McapOp::kMessage));
  header.number(std::uint64_t{2 + 4 + 8 + 8 + message.bytes.size()});
  header.number(channel).number(message.sequence).number(log_ns).number(unsigned_ns(message.publish_ns));
  chunk_ += header.bytes();
  chunk_ += as_text(message.bytes);
  return chunk_.size() < kChunk_bytes ? Result<void>() : end_chunk();
}

/// The indexes of the chunk's messages, which begin at `at`; `places` gets where each of them is.
std::string McapSink::message_indexes(std::uint64_t at, std::string& places) {
  std::string indexes;
  McapContent offsets;
  for (auto& [channel, entries] : index_) {
    std::ranges::stable_sort(entries, {}, &IndexEntry::ns);  // readers may search in it
    McapContent content;
    for (const IndexEntry& entry : entries) content.number(entry.ns).number(entry.at);
    offsets.number(channel).number(at + indexes.size());
    indexes += mcap_record(McapOp::kMessageIndex, McapContent().number(channel).text(content.bytes()));
  }
  places = offsets.bytes();
  index_.clear();
  return indexes;
}

Result<void> McapSink::end_chunk() {
  if (chunk_.empty()) return {};
  const std::uint64_t chunk_at = at_;
  const bool plain = compression_ == Compression::kNone;
  const std::string packed = plain ? std::string() : compressed(compression_, chunk_);
  const std::string_view records = plain ? std::string_view(chunk_) : packed;
  McapContent header;
  header.number(chunk_times_.start_ns()).number(chunk_times_.last_ns).number(std::uint64_t{chunk_.size()});
  header.number(crc32_of(std::as_bytes(std::span(chunk_)))).text(name_in_mcap(compression_));
  header.number(std::uint64_t{records.size()});
  const std::uint64_t content_bytes = header.bytes().size() + records.size();
  McapContent beginning;
  beginning.number(static_cast<std::uint8_t>(McapOp::kChunk)).number(content_bytes).raw(header.bytes());
  auto written = write_bytes(beginning.bytes()).and_then([&] { return write_bytes(records); });
  if (!written) return written;
  const std::uint64_t chunk_bytes = at_ - chunk_at;
  std::string places;
  const std::string indexes = message_indexes(at_, places);
  McapContent index;
  index.number(chunk_times_.start_ns()).number(chunk_times_.last_ns).number(chunk_at).number(chunk_bytes);
  index.text(places).number(std::uint64_t{indexes.size()}).text(name_in_mcap(compression_));
  index.number(std::uint64_t{records.size()}).number(std::uint64_t{chunk_.size()});
  chunk_indexes_ += mcap_record(McapOp::kChunkIndex, index);
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
  return write_bytes(indexes);
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
                                              .number(static_cast<std::uint16_t>(described_.size()))
                                              .number(static_cast<std::uint32_t>(counts_.size()))
                                              .number(attachments_)
                                              .number(metadata_)
                                              .number(chunks_)
                                              .number(times_.start_ns())
                                              .number(times_.last_ns)
                                              .text(counts.bytes()));
}

/// The groups of the summary, which begins at `summary_at`, the places of the groups, and the footer.
std::string McapSink::summary(std::uint64_t summary_at) const {
  std::string groups, places;
  const auto add = [&](McapOp op, const std::string& records) {
    if (records.empty()) return;
    places += mcap_record(McapOp::kSummaryOffset, McapContent()
                                                      .number(static_cast<std::uint8_t>(op))
                                                      .number(summary_at + groups.size())
                                                      .number(std::uint64_t{records.size()}));
    groups += records;
  };
  add(McapOp::kSchema, schemas_);
  add(McapOp::kChannel, channels_);
  add(McapOp::kStatistics, statistics());
  add(McapOp::kChunkIndex, chunk_indexes_);
  add(McapOp::kAttachmentIndex, attachment_indexes_);
  add(McapOp::kMetadataIndex, metadata_indexes_);
  McapContent footer;  // the summary has no checksum
  footer.number(summary_at).number(summary_at + groups.size()).number(std::uint32_t{0});
  return groups + places + mcap_record(McapOp::kFooter, footer);
}

Result<void> McapSink::finish(const std::vector<std::string>& records) {
  if (auto ended = end_chunk(); !ended) return ended;
  for (const std::string& record : records) {
    const std::string metadata =
        mcap_record(McapOp::kMetadata,
                    McapContent().text(kAppliedMetadata).text(metadata_map({{"record", record}}).bytes()));
    metadata_indexes_ +=
        mcap_record(McapOp::kMetadataIndex,
                    McapContent().number(at_).number(std::uint64_t{metadata.size()}).text(kAppliedMetadata));
    ++metadata_;
    if (auto written = write_bytes(metadata); !written) return written;
  }
  const std::string end = mcap_record(McapOp::kDataEnd, McapContent().number(std::uint32_t{0}));
  return write_bytes(end)
      .and_then([&] { return write_bytes(summary(at_)); })
      .and_then([&] { return write_bytes(kMcapMagic); })
      .and_then([&] { return file_.commit(); });
}

}  // namespace

Result<std::unique_ptr<MessageSink>> create_mcap_sink(const fs::path& path, Compression compression,
                                                      const std::string& profile,
                                                      const std::vector<fs::path>& kept_from) {
  auto file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  auto sink = std::make_unique<McapSink>(std::move(*file), compression);
  if (const auto begun = sink->begin(profile, kept_from); !begun) return tl::unexpected(begun.error());
  return sink;
}

}  // namespace sweepscope
