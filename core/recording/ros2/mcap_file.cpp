#include "core/recording/ros2/mcap_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/io/input_file.hpp"
#include "core/recording/packed/compress.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/ros2/mcap_records.hpp"

namespace sweepscope {
namespace {

struct RecordHeader {
  std::uint64_t at = 0;
  McapOp op = McapOp::kHeader;
  std::uint64_t content_bytes = 0;  // as claimed
};

struct Chunk {
  std::uint64_t unpacked_bytes = 0;  // as claimed
  std::uint32_t crc = 0;             // 0: not given
  std::string_view compression;
  std::span<const std::byte> records;  // as far as they are there
};

struct Schema {
  std::string name, encoding, definition;
};

/// Those that the specification has, and private ones, which it leaves to others.
bool is_known(McapOp op) {
  constexpr auto kLast = McapOp::kDataEnd;
  return (op >= McapOp::kHeader && op <= kLast) || static_cast<std::uint8_t>(op) >= 0x80;
}

bool is_of_chunks(McapOp op) {
  return op == McapOp::kSchema || op == McapOp::kChannel || op == McapOp::kMessage ||
         static_cast<std::uint8_t>(op) >= 0x80;
}

std::int64_t as_ns(std::uint64_t ns) {
  return ns <= static_cast<std::uint64_t>(INT64_MAX) ? static_cast<std::int64_t>(ns) : 0;
}

/// Reads one file. Members hold what is known so far; memory holds one chunk, packed and unpacked.
class McapReader {
 public:
  McapReader(InputFile& file, std::string name, UnpackingLimit& limit, const McapVisitor& visit,
             const McapChannelVisitor& visit_channel)
      : file_(file), name_(std::move(name)), limit_(limit), visit_(visit), visit_channel_(visit_channel) {}

  Result<std::vector<std::string>> read(const Job& job);

 private:
  bool read_header(RecordHeader& header);
  std::span<const std::byte> read_content(std::uint64_t bytes);
  std::optional<Error> read_record(const RecordHeader& header);
  std::optional<Error> take(McapOp op, std::span<const std::byte> content, const BagPlace& place);
  std::optional<Error> read_chunk(std::span<const std::byte> content, const BagPlace& place, bool whole);
  std::optional<Error> read_unpacked(std::span<const std::byte> records, BagPlace place, bool whole);
  void add_schema(std::span<const std::byte> content, const BagPlace& place);
  void add_channel(std::span<const std::byte> content, const BagPlace& place);
  std::optional<Error> visit_message(std::span<const std::byte> content, const BagPlace& place);
  bool ends_whole();
  void learn_from_summary();
  void check_unused(const RecordHeader& header);
  void end_early(const RecordHeader& header, std::uint64_t left);
  void warn(const std::string& what);
  std::vector<std::string> finish();

  InputFile& file_;
  std::string name_;
  UnpackingLimit& limit_;
  const McapVisitor& visit_;
  const McapChannelVisitor& visit_channel_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::vector<std::byte> packed_, unpacked_;
  Compression compression_ = Compression::kNone;  // of the chunk that is read
  bool ended_ = false, cut_short_ = false, in_summary_ = false;
  bool ends_whole_ = false;  // with the magic bytes that end a file: it is not cut short
  bool stopped_ = false;     // at damage that the file is read no further than
  std::size_t orphans_ = 0;  // messages of channels that nothing describes
  static constexpr std::size_t kMaxWarnings = 20;
  std::size_t warnings_left_out_ = 0;
  std::vector<std::string> warnings_;
};

void McapReader::warn(const std::string& what) {
  if (warnings_.size() < kMaxWarnings)
    warnings_.push_back(what);
  else
    ++warnings_left_out_;
}

/// False at the end of what can be read.
bool McapReader::read_header(RecordHeader& header) {
  header.at = file_.position();
  std::array<std::byte, kMcapRecordHeader_bytes> bytes;
  const std::size_t got = file_.read(bytes);
  if (got < bytes.size()) {
    cut_short_ = got > 0 && !ends_whole_;
    return false;
  }
  McapFields fields(bytes);
  header.op = static_cast<McapOp>(fields.number<std::uint8_t>());
  header.content_bytes = fields.number<std::uint64_t>();
  return true;
}

/// As far as the file goes.
std::span<const std::byte> McapReader::read_content(std::uint64_t bytes) {
  bytes = std::min(bytes, file_.left());
  if (packed_.size() < bytes) packed_.resize(bytes);
  const std::span<std::byte> content = std::span(packed_).first(bytes);
  return content.first(file_.read(content));
}

std::optional<Error> McapReader::read_record(const RecordHeader& header) {
  const BagPlace place{header.at, std::nullopt};
  const bool used = header.op == McapOp::kSchema || header.op == McapOp::kChannel ||
                    header.op == McapOp::kMessage || header.op == McapOp::kChunk;
  if (!used) {
    if (header.content_bytes <= file_.left()) check_unused(header);
    return std::nullopt;
  }
  if (header.content_bytes > kMaxMcapChunk_bytes) {
    warn(fmt::format(
        "the record at {} claims {} bytes, more than the {} that are read at once, and was skipped",
        place.text(), header.content_bytes, kMaxMcapChunk_bytes));
    return std::nullopt;
  }
  const auto content = read_content(header.content_bytes);
  const bool whole = content.size() == header.content_bytes;
  if (header.op == McapOp::kChunk) return read_chunk(content, place, whole);
  return whole ? take(header.op, content, place) : std::nullopt;  // the end is reported by the caller
}

/// Says where a record that holds no messages cannot be what its op code says.
void McapReader::check_unused(const RecordHeader& header) {
  const auto number = static_cast<unsigned>(header.op);
  if (!is_known(header.op)) {
    return warn(fmt::format(
        "the record at byte {} has op code {:#04x}, which MCAP does not have, and was skipped: it is damaged",
        header.at, number));
  }
  bool fits = header.op != McapOp::kDataEnd || header.content_bytes == sizeof(std::uint32_t);
  if (header.op == McapOp::kMessageIndex) {
    constexpr std::uint64_t kStart_bytes = sizeof(std::uint16_t) + sizeof(std::uint32_t);
    const auto start = read_content(std::min(header.content_bytes, kStart_bytes));
    McapFields fields(start);
    fields.number<std::uint16_t>();
    fits = kStart_bytes + fields.number<std::uint32_t>() == header.content_bytes && fields.whole();
  }
  if (!fits) {
    warn(
        fmt::format("the record at byte {} is damaged, and was skipped: its op code {:#04x} and its content "
                    "do not fit each other",
                    header.at, number));
  }
}

std::optional<Error> McapReader::take(McapOp op, std::span<const std::byte> content, const BagPlace& place) {
  if (op == McapOp::kSchema) add_schema(content, place);
  if (op == McapOp::kChannel) add_channel(content, place);
  return op == McapOp::kMessage ? visit_message(content, place) : std::nullopt;
}

std::optional<Error> McapReader::read_chunk(std::span<const std::byte> content, const BagPlace& place,
                                            bool whole) {
  McapFields fields(content);
  fields.number<std::uint64_t>();  // the first and the last message's time
  fields.number<std::uint64_t>();
  Chunk chunk;
  chunk.unpacked_bytes = fields.number<std::uint64_t>();
  chunk.crc = fields.number<std::uint32_t>();
  chunk.compression = fields.text();
  const auto packed_bytes = fields.number<std::uint64_t>();
  if (!fields.whole() || (whole && packed_bytes > fields.rest().size())) {
    if (whole) warn(fmt::format("the chunk at {} is damaged and was skipped", place.text()));
    return std::nullopt;
  }
  chunk.records = fields.rest().first(std::min<std::uint64_t>(packed_bytes, fields.rest().size()));
  const auto compression = mcap_compression(chunk.compression);
  if (!compression) {
    warn(fmt::format("the chunk at {} is compressed as \"{}\", which is not lz4 or zstd, and was skipped",
                     place.text(), chunk.compression));
    return std::nullopt;
  }
  compression_ = *compression;
  const Decompressed unpacked =
      decompress(*compression, chunk.records, limit_.max_bytes(kMaxMcapChunk_bytes), unpacked_);
  if (*compression != Compression::kNone)
    if (auto error = limit_.take(unpacked.bytes.size() + (unpacked.too_long ? 1 : 0))) return error;
  const bool sound = whole && unpacked.problem.empty();
  if (whole && !sound) {
    warn(fmt::format("the chunk at {} is damaged ({}); the intact part before the damage was used",
                     place.text(), unpacked.problem));
  } else if (whole && chunk.unpacked_bytes != unpacked.bytes.size()) {
    warn(fmt::format("the chunk at {} claims {} unpacked bytes and holds {}", place.text(),
                     chunk.unpacked_bytes, unpacked.bytes.size()));
  }
  if (sound && chunk.crc != 0 && crc32_of(unpacked.bytes) != chunk.crc) {
    warn(fmt::format("the chunk at {} does not have the checksum that it claims, and was skipped",
                     place.text()));
    return std::nullopt;
  }
  return read_unpacked(unpacked.bytes, place, sound);
}

/// The records of a chunk. Of one that is not whole, what is missing was reported already.
std::optional<Error> McapReader::read_unpacked(std::span<const std::byte> records, BagPlace place,
                                               bool whole) {
  std::size_t at = 0;
  while (at < records.size()) {
    place.chunk_byte = at;
    McapFields fields(records.subspan(at));
    const auto op = static_cast<McapOp>(fields.number<std::uint8_t>());
    const auto bytes = fields.number<std::uint64_t>();
    if (!fields.whole() || bytes > fields.rest().size()) {
      if (whole) {
        warn(fmt::format("there is no complete record at {}; the rest of the chunk, {} bytes, was skipped",
                         place.text(), records.size() - at));
      }
      return std::nullopt;
    }
    if (!in_summary_ && !is_of_chunks(op)) {
      warn(
          fmt::format("the record at {} has op code {:#04x}, which no record in a chunk has, and was "
                      "skipped: it is damaged",
                      place.text(), static_cast<unsigned>(op)));
    }
    if (auto error = take(op, fields.rest().first(bytes), place)) return error;
    at += kMcapRecordHeader_bytes + bytes;
  }
  return std::nullopt;
}

void McapReader::add_schema(std::span<const std::byte> content, const BagPlace& place) {
  McapFields fields(content);
  const auto id = fields.number<std::uint16_t>();
  const std::string_view name = fields.text(), encoding = fields.text(), definition = fields.text();
  if (fields.whole() && id != 0) {
    schemas_.insert_or_assign(id, Schema{std::string(name), std::string(encoding), std::string(definition)});
  } else {
    warn(fmt::format("the schema at {} is damaged and was skipped", place.text()));
  }
}

void McapReader::add_channel(std::span<const std::byte> content, const BagPlace& place) {
  McapFields fields(content);
  const auto id = fields.number<std::uint16_t>();
  const auto schema = schemas_.find(fields.number<std::uint16_t>());
  McapChannel channel;
  channel.topic = fields.text();
  channel.encoding = fields.text();
  if (!fields.whole()) {
    warn(fmt::format("the channel at {} is damaged and was skipped", place.text()));
    return;
  }
  if (schema != schemas_.end()) {
    channel.type = schema->second.name;
    channel.schema_encoding = schema->second.encoding;
    channel.definition = schema->second.definition;
  }
  fields.number<std::uint32_t>();  // the bytes of the metadata: names and values to the end
  while (fields.whole() && !fields.rest().empty()) {
    const std::string_view name = fields.text(), value = fields.text();
    if (name == "md5sum" && !value.empty()) channel.md5sum = value;
    if (fields.whole()) channel.metadata.emplace_back(name, value);
  }
  const auto [entry, is_new] = channels_.try_emplace(id);
  McapChannel& known = entry->second;
  if (!is_new && known == channel) return;
  known = std::move(channel);
  if (visit_channel_) visit_channel_(known);
}

std::optional<Error> McapReader::visit_message(std::span<const std::byte> content, const BagPlace& place) {
  if (in_summary_) return std::nullopt;  // no place for a message
  McapFields fields(content);
  const auto id = fields.number<std::uint16_t>();
  const auto sequence = fields.number<std::uint32_t>();
  const auto log_ns = fields.number<std::uint64_t>(), publish_ns = fields.number<std::uint64_t>();
  const auto channel = channels_.find(id);
  if (!fields.whole() || channel == channels_.end()) {
    if (orphans_++ == 0) {
      warn(fmt::format(
          "the message at {} belongs to no channel that the file describes; such messages are skipped",
          place.text()));
    }
    return std::nullopt;
  }
  return visit_(
      {channel->second, as_ns(log_ns), fields.rest(), place, sequence, as_ns(publish_ns), compression_});
}

/// The schemas and channels of the summary, where there is a sound one. What is wrong there is said when the
/// reading comes there.
void McapReader::learn_from_summary() {
  constexpr std::size_t kEnd_bytes = kMcapRecordHeader_bytes + kMcapFooter_bytes + kMcapMagic.size();
  const std::uint64_t here = file_.position();
  RecordHeader header;
  std::array<std::byte, kMcapFooter_bytes> footer;
  file_.seek(file_.size() - std::min<std::uint64_t>(file_.size(), kEnd_bytes));
  if (read_header(header) && header.op == McapOp::kFooter && file_.read(footer) == footer.size()) {
    const auto summary_at = McapFields(footer).number<std::uint64_t>();
    if (summary_at > here && summary_at < header.at && header.at - summary_at <= kMaxMcapSummary_bytes) {
      file_.seek(summary_at);
      const auto records = read_content(header.at - summary_at);
      in_summary_ = true;
      read_unpacked(records, {summary_at, std::nullopt}, false);
      in_summary_ = false;
    }
  }
  warnings_.clear();
  warnings_left_out_ = orphans_ = 0;
  cut_short_ = false;
  file_.seek(here);
}

/// At a record that claims to end beyond the file.
void McapReader::end_early(const RecordHeader& header, std::uint64_t left) {
  cut_short_ = !ends_whole_;
  if (cut_short_) return;
  stopped_ = true;
  warn(
      fmt::format("the length of the record at byte {} is damaged: it claims {} bytes, and the file, which "
                  "is not cut short, has {} more; those were not read",
                  header.at, header.content_bytes, left));
}

bool McapReader::ends_whole() {
  const std::uint64_t here = file_.position();
  std::array<char, kMcapMagic.size()> magic{};
  file_.seek(file_.size() - std::min<std::uint64_t>(file_.size(), magic.size()));
  const bool whole = here + magic.size() <= file_.size() &&
                     file_.read(std::as_writable_bytes(std::span(magic))) == magic.size() &&
                     std::string_view(magic.data(), magic.size()) == kMcapMagic;
  file_.seek(here);
  return whole;
}

std::vector<std::string> McapReader::finish() {
  if (cut_short_) {
    warn(fmt::format("it is cut short at byte {}; its intact part was read", file_.size()));
  } else if (!ended_ && !stopped_ && ends_whole_) {
    warn("its footer is damaged; the intact part before it was read");
  } else if (!ended_ && !stopped_) {
    warn("it was never closed (it has no footer); its intact part was read");
  }
  if (warnings_left_out_ > 0)
    warnings_.push_back(fmt::format("{} more places are damaged", warnings_left_out_));
  if (orphans_ > 1) warnings_.push_back(fmt::format("{} messages belong to no channel", orphans_));
  return std::move(warnings_);
}

Result<std::vector<std::string>> McapReader::read(const Job& job) {
  file_.seek(kMcapMagic.size());
  ends_whole_ = ends_whole();
  learn_from_summary();
  RecordHeader header;
  while (!ended_ && read_header(header)) {
    const std::uint64_t left = file_.left(), content_at = file_.position();
    ended_ = header.op == McapOp::kFooter;
    if (auto error = read_record(header)) return tl::unexpected(std::move(*error));
    if (header.content_bytes > left) {
      end_early(header, left);
      break;
    }
    file_.seek(content_at + header.content_bytes);
    job.report("reading", static_cast<double>(file_.position()) / static_cast<double>(file_.size()));
    if (job.cancelled())
      return failure(ExitCode::kInterrupted, fmt::format("{}: reading was interrupted", name_));
  }
  return finish();
}

}  // namespace

Result<std::vector<std::string>> read_mcap(const std::filesystem::path& path, const McapVisitor& visit,
                                           const Job& job) {
  UnpackingLimit limit(path);
  return read_mcap(path, limit, visit, job);
}

Result<std::vector<std::string>> read_mcap(const std::filesystem::path& path, UnpackingLimit& limit,
                                           const McapVisitor& visit, const Job& job,
                                           const McapChannelVisitor& visit_channel) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::array<char, kMcapMagic.size()> magic{};
  file->read(std::as_writable_bytes(std::span(magic)));
  if (std::string_view(magic.data(), magic.size()) != kMcapMagic)
    return unreadable(fmt::format("{}: byte 0 does not begin an MCAP file of version 0", path.string()));
  return McapReader(*file, path.string(), limit, visit, visit_channel).read(job);
}

}  // namespace sweepscope
