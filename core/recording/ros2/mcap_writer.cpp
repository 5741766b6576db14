#include "core/recording/ros2/mcap_writer.hpp"

#include <algorithm>
#include <limits>

#include "core/recording/packed/compress.hpp"
#include "core/recording/ros2/mcap_content.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk_bytes = std::size_t{768} << 10;  // as the reference writers have it

McapContent metadata_map(const std::vector<std::pair<std::string, std::string>>& entries) {
  McapContent map;
  for (const auto& [name, value] : entries) map.text(name).text(value);
  return map;
}

/// The beginning of a record whose content is `bytes` long.
std::string record_header(McapOp op, std::uint64_t bytes) {
  return McapContent().number(static_cast<std::uint8_t>(op)).number(bytes).bytes();
}

}  // namespace

void McapWriter::TimeSpan::add(std::uint64_t ns) {
  first_ns = std::min(first_ns, ns);
  last_ns = std::max(last_ns, ns);
}

Result<McapWriter> McapWriter::create(const fs::path& path, Compression compression,
                                      std::string_view profile) {
  auto file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  McapWriter writer(std::move(*file), compression);
  const std::string header =
      mcap_record(McapOp::kHeader, McapContent().text(profile).text("sweepscope " SWEEPSCOPE_VERSION));
  if (auto written = writer.put(std::string(kMcapMagic) + header); !written)
    return tl::unexpected(written.error());
  return writer;
}

Result<void> McapWriter::put(std::string_view bytes) {
  at_ += bytes.size();
  return file_.write(bytes);
}

/// The number of the channel's schema, which may have been described for another one; 0: it has none.
std::uint16_t McapWriter::schema_of(const McapChannel& channel) {
  if (channel.type.empty()) return 0;
  const Schema schema{channel.type, channel.schema_encoding, channel.definition};
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

Result<std::uint16_t> McapWriter::add_channel(const McapChannel& channel) {
  if (counts_.size() >= std::numeric_limits<std::uint16_t>::max())
    return tl::unexpected(file_.error("an MCAP file holds no more than 65535 channels"));
  const std::uint16_t schema = schema_of(channel);
  const auto number = static_cast<std::uint16_t>(counts_.size());
  const std::string record = mcap_record(McapOp::kChannel, McapContent()
                                                               .number(number)
                                                               .number(schema)
                                                               .text(channel.topic)
                                                               .text(channel.encoding)
                                                               .text(metadata_map(channel.metadata).bytes()));
  channel_records_ += record;
  chunk_ += record;
  counts_.push_back(0);
  return number;
}

Result<void> McapWriter::write(const McapMessageHeader& message, std::span<const std::byte> data) {
  index_[message.channel].push_back({message.log_ns, chunk_.size()});
  chunk_times_.add(message.log_ns);
  times_.add(message.log_ns);
  ++counts_[message.channel];
  McapContent fields;
  fields.number(message.channel).number(message.sequence).number(message.log_ns).number(message.publish_ns);
  chunk_ += record_header(McapOp::kMessage, fields.bytes().size() + data.size());
  chunk_ += fields.bytes();
  chunk_.append(reinterpret_cast<const char*>(data.data()), data.size());
  return chunk_.size() < kChunk_bytes ? Result<void>() : end_chunk();
}

void McapWriter::note_metadata(std::uint64_t bytes, std::string_view name) {
  metadata_indexes_ +=
      mcap_record(McapOp::kMetadataIndex, McapContent().number(at_).number(bytes).text(name));
  ++metadata_;
}

Result<void> McapWriter::write_metadata(std::string_view name,
                                        const std::vector<std::pair<std::string, std::string>>& entries) {
  if (auto ended = end_chunk(); !ended) return ended;
  const std::string record =
      mcap_record(McapOp::kMetadata, McapContent().text(name).text(metadata_map(entries).bytes()));
  note_metadata(record.size(), name);
  return put(record);
}

Result<void> McapWriter::copy(const fs::path& from, const McapExtra& extra) {
  constexpr std::uint64_t kBeginning_bytes = std::uint64_t{64} << 10;  // of an attachment: before its data
  if (auto ended = end_chunk(); !ended) return ended;
  std::string beginning;
  const auto read = read_mcap_extra(from, extra, kBeginning_bytes, [&](std::string_view block) {
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
std::string McapWriter::message_indexes(std::string& places) {
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
Result<void> McapWriter::end_chunk() {
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

std::string McapWriter::statistics() const {
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
std::string McapWriter::summary() const {
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

Result<void> McapWriter::finish() {
  return end_chunk()
      .and_then([&] { return put(mcap_record(McapOp::kDataEnd, McapContent().number(std::uint32_t{0}))); })
      .and_then([&] { return put(summary()); })
      .and_then([&] { return put(kMcapMagic); })
      .and_then([&] { return file_.commit(); });
}

}  // namespace sweepscope
