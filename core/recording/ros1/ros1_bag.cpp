#include "core/recording/ros1/ros1_bag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/io/input_file.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/packed/unpacking_limit.hpp"
#include "core/recording/ros1/ros1_record.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMaxWarnings = 20;

/// Whether a record has the fields that its op code asks for; a damaged op code has others.
bool fits_its_op(const BagFields& fields) {
  const auto has = [&](std::string_view name) { return fields.find(name).has_value(); };
  const auto op = fields.op();
  if (!op) return false;
  switch (*op) {
    case BagOp::kMessage:
      return has("conn") && fields.time_ns();
    case BagOp::kBagHeader:
      return has("index_pos") || has("encryptor");
    case BagOp::kIndex:
      return has("conn") && has("count");
    case BagOp::kChunk:
      return has("compression");
    case BagOp::kChunkInfo:
      return has("chunk_pos");
    case BagOp::kConnection:
      return has("conn") && has("topic");
  }
  return false;
}

/// Reads one bag. Members hold what is known so far; memory holds one chunk, packed and unpacked.
class BagReader {
 public:
  BagReader(InputFile& file, std::string name, const BagVisitor& visit,
            const BagConnectionVisitor& visit_connection)
      : file_(file),
        name_(std::move(name)),
        visit_(visit),
        visit_connection_(visit_connection),
        limit_(name_, file.size()) {}

  Result<std::vector<std::string>> read(const Job& job);

 private:
  struct Header {
    std::uint64_t at = 0;
    std::vector<std::byte> bytes;
    std::uint64_t data_bytes = 0;  // as claimed
    std::uint64_t data_at = 0;
  };

  bool read_header(Header& header);
  std::span<const std::byte> read_data(const Header& header);
  std::optional<Error> read_record(const Header& header);
  std::optional<Error> read_bag_header(const BagFields& fields);
  std::optional<Error> read_chunk(const Header& header, const BagFields& fields);
  std::optional<Error> read_unpacked(std::span<const std::byte> chunk, BagPlace place, bool whole);
  void add_connection(const BagFields& fields, std::span<const std::byte> data, const BagPlace& place);
  void describe(BagConnection connection, const BagPlace& place);
  std::optional<Error> visit_message(const BagFields& fields, std::span<const std::byte> data,
                                     const BagPlace& place);
  bool check_op(const BagFields& fields, const BagPlace& place);
  void learn_from_index();
  bool ends_whole();
  void warn_of_end(std::uint64_t at, std::uint64_t end);
  void check_end();
  void warn(const std::string& what);
  Result<std::vector<std::string>> finish();

  InputFile& file_;
  std::string name_;
  const BagVisitor& visit_;
  const BagConnectionVisitor& visit_connection_;
  UnpackingLimit limit_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<std::byte> packed_, unpacked_;
  Compression compression_ = Compression::kNone;  // of the chunk that is read
  std::optional<std::uint64_t> index_at_;         // as claimed; 0 in a bag that was never closed
  bool cut_short_ = false;
  bool ends_whole_ = false;  // its index lies where it should, up to the file's end: it is not cut short
  std::size_t orphans_ = 0;  // messages of connections that nothing describes
  std::size_t warnings_left_out_ = 0;
  std::vector<std::string> warnings_;
};

void BagReader::warn(const std::string& what) {
  if (warnings_.size() >= kMaxWarnings) {
    ++warnings_left_out_;
    return;
  }
  warnings_.push_back(what);
}

/// A record's header and the length of its data. False at the end of what can be read.
bool BagReader::read_header(Header& header) {
  header.at = file_.position();
  if (file_.left() == 0) return false;
  std::array<std::byte, 4> length;
  const auto stop = [&](const std::string& why) {
    warn(fmt::format("{} at byte {}; the last {} bytes of the file are not used", why, header.at,
                     file_.size() - header.at));
    return false;
  };
  const auto stop_cut = [&] {
    cut_short_ = true;
    return stop(ends_whole_ ? "the file is complete, but a length is damaged in the record"
                            : "it is cut short in the record");
  };
  if (file_.read(length) != length.size()) return stop_cut();
  const std::uint64_t header_bytes = load<std::uint32_t>(length);
  if (header_bytes > kMaxHeader_bytes) return stop("there is no record");
  if (header_bytes > file_.left()) return stop_cut();
  header.bytes.resize(header_bytes);
  if (file_.read(header.bytes) != header_bytes) return stop_cut();
  if (!BagFields::parse(header.bytes)) return stop("there is no record");
  if (file_.read(length) != length.size()) return stop_cut();
  header.data_bytes = load<std::uint32_t>(length);
  header.data_at = file_.position();
  return true;
}

/// The data of a record, as far as the file goes.
std::span<const std::byte> BagReader::read_data(const Header& header) {
  const std::uint64_t bytes = std::min(header.data_bytes, file_.left());
  if (packed_.size() < bytes) packed_.resize(bytes);
  const std::span<std::byte> data = std::span(packed_).first(bytes);
  return data.first(file_.read(data));
}

std::optional<Error> BagReader::read_record(const Header& header) {
  const BagFields fields = *BagFields::parse(header.bytes);
  const BagPlace place{header.at, std::nullopt};
  if (!check_op(fields, place)) return std::nullopt;
  const auto op = fields.op();
  if (op == BagOp::kBagHeader) return read_bag_header(fields);
  if (op != BagOp::kChunk && op != BagOp::kConnection && op != BagOp::kMessage) return std::nullopt;
  if (header.data_bytes > kMaxChunk_bytes) {
    warn(fmt::format(
        "the record at {} claims {} bytes, more than the {} that are read at once, and was skipped",
        place.text(), header.data_bytes, kMaxChunk_bytes));
    return std::nullopt;
  }
  if (op == BagOp::kChunk) return read_chunk(header, fields);
  const std::span<const std::byte> data = read_data(header);
  if (data.size() < header.data_bytes) return std::nullopt;  // the end is reported by the caller
  if (op == BagOp::kMessage) return visit_message(fields, data, place);
  add_connection(fields, data, place);
  return std::nullopt;
}

std::optional<Error> BagReader::read_bag_header(const BagFields& fields) {
  if (const auto encryptor = fields.text("encryptor"); encryptor && !encryptor->empty()) {
    return Error{
        ExitCode::kUnreadableInput,
        fmt::format("{}: is encrypted ({}); decrypt it first with `rosbag decompress`", name_, *encryptor)};
  }
  if (index_at_) return std::nullopt;
  index_at_ = fields.number<std::uint64_t>("index_pos").value_or(0);
  learn_from_index();
  return std::nullopt;
}

/// Says where what a record is and what it holds do not fit each other.
bool BagReader::check_op(const BagFields& fields, const BagPlace& place) {
  if (fits_its_op(fields)) return true;
  const auto op = fields.number<std::uint8_t>("op");
  warn(
      fmt::format("the record at {} is damaged, and was skipped: its op code{} and its other fields do not "
                  "fit each other",
                  place.text(), op ? fmt::format(", {},", *op) : ""));
  return false;
}

/// Whether records follow each other from here to the file's end.
bool BagReader::ends_whole() {
  Header header;
  while (read_header(header)) {
    if (header.data_bytes > file_.left()) return false;
    file_.seek(header.data_at + header.data_bytes);
  }
  return file_.left() == 0;
}

/// A sound index describes every connection again, which helps where the chunk that introduced one is
/// damaged.
void BagReader::learn_from_index() {
  if (*index_at_ == 0 || *index_at_ >= file_.size()) return;
  const std::uint64_t here = file_.position();
  file_.seek(*index_at_);
  const std::size_t warnings_before = warnings_.size(), left_out_before = warnings_left_out_;
  Header header;
  while (read_header(header)) {
    const BagFields fields = *BagFields::parse(header.bytes);
    if (fields.op() != BagOp::kConnection || header.data_bytes > kMaxHeader_bytes) break;
    const std::span<const std::byte> data = read_data(header);
    if (data.size() < header.data_bytes) break;
    add_connection(fields, data, {header.at, std::nullopt});
  }
  file_.seek(*index_at_);
  ends_whole_ = ends_whole();
  // What is wrong there is said when the reading comes there.
  warnings_.resize(warnings_before);
  warnings_left_out_ = left_out_before;
  cut_short_ = false;
  file_.seek(here);
}

std::optional<Error> BagReader::read_chunk(const Header& header, const BagFields& fields) {
  const BagPlace place{header.at, std::nullopt};
  const auto name = fields.text("compression");
  const auto compression = name ? compression_named(*name) : std::nullopt;
  if (!compression) {
    warn(
        fmt::format("the chunk at {} is compressed as \"{}\", which is not none, bz2 or lz4, and was skipped",
                    place.text(), name.value_or("")));
    return std::nullopt;
  }
  compression_ = *compression;
  const std::span<const std::byte> packed = read_data(header);
  const bool whole = packed.size() == header.data_bytes;
  const Decompressed unpacked =
      decompress(*compression, packed, limit_.max_bytes(kMaxChunk_bytes), unpacked_);
  if (*compression != Compression::kNone)
    if (auto error = limit_.take(unpacked.bytes.size() + (unpacked.too_long ? 1 : 0))) return error;
  const auto claimed_bytes = fields.number<std::uint32_t>("size");
  if (whole && !unpacked.problem.empty()) {
    warn(fmt::format("the chunk at {} is damaged ({}); the intact part before the damage was used",
                     place.text(), unpacked.problem));
  } else if (whole && claimed_bytes != unpacked.bytes.size()) {
    warn(fmt::format("the chunk at {} claims {} unpacked bytes and holds {}", place.text(),
                     claimed_bytes.value_or(0), unpacked.bytes.size()));
  }
  return read_unpacked(unpacked.bytes, place, whole && unpacked.problem.empty());
}

/// The records of a chunk. Of one that is not whole, what is missing was reported already.
std::optional<Error> BagReader::read_unpacked(std::span<const std::byte> chunk, BagPlace place, bool whole) {
  std::size_t at = 0;
  while (at < chunk.size()) {
    place.chunk_byte = at;
    const auto record = parse_record(chunk.subspan(at));
    if (!record) {
      if (whole) {
        warn(fmt::format("there is no complete record at {}; the rest of the chunk, {} bytes, was skipped",
                         place.text(), chunk.size() - at));
      }
      return std::nullopt;
    }
    at += record->length;
    if (!check_op(record->fields, place)) continue;
    const auto op = record->fields.op();
    if (op == BagOp::kConnection) add_connection(record->fields, record->data, place);
    if (op == BagOp::kMessage) {
      if (auto error = visit_message(record->fields, record->data, place)) return error;
    }
  }
  return std::nullopt;
}

void BagReader::add_connection(const BagFields& fields, std::span<const std::byte> data,
                               const BagPlace& place) {
  const auto id = fields.number<std::uint32_t>("conn");
  const auto topic = fields.text("topic");
  const auto description = BagFields::parse(data);
  const auto type = description ? description->text("type") : std::nullopt;
  if (!id || !topic || !type) {
    warn(fmt::format("the connection at {} is damaged and was skipped", place.text()));
    return;
  }
  describe({*id, std::string(*topic), std::string(*type),
            std::string(description->text("md5sum").value_or("*")), std::string(as_text(data))},
           place);
}

/// The chunk that introduces a connection and the index both describe it, in the same way.
void BagReader::describe(BagConnection connection, const BagPlace& place) {
  const auto [known, is_new] = connections_.try_emplace(connection.id, connection);
  BagConnection& before = known->second;
  if (is_new && visit_connection_) visit_connection_(before);
  if (is_new || (before.topic == connection.topic && before.type == connection.type &&
                 before.md5sum == connection.md5sum))
    return;
  warn(
      fmt::format("the connection at {} is of topic {}, type {} and md5sum {}, and the bag describes the "
                  "same one as of topic {}, type {} and md5sum {}: one of the two is damaged",
                  place.text(), connection.topic, connection.type, connection.md5sum, before.topic,
                  before.type, before.md5sum));
  before = std::move(connection);
  if (visit_connection_) visit_connection_(before);
}

std::optional<Error> BagReader::visit_message(const BagFields& fields, std::span<const std::byte> data,
                                              const BagPlace& place) {
  const auto id = fields.number<std::uint32_t>("conn");
  const auto receive_ns = fields.time_ns();
  const auto connection = id ? connections_.find(*id) : connections_.end();
  if (connection == connections_.end() || !receive_ns) {
    if (orphans_++ == 0) {
      warn(fmt::format(
          "the message at {} belongs to no connection that the bag describes; such messages are skipped",
          place.text()));
    }
    return std::nullopt;
  }
  return visit_({connection->second, *receive_ns, data, place, compression_});
}

/// Of a record that claims to end beyond the file.
void BagReader::warn_of_end(std::uint64_t at, std::uint64_t end) {
  cut_short_ = true;
  if (ends_whole_) {
    return warn(
        fmt::format("the length of the record at byte {} is damaged: it would end at byte {}, and the file "
                    "is whole and ends at byte {}; what follows in it was not read",
                    at, end, file_.size()));
  }
  warn(
      fmt::format("it is cut short: the record at byte {} ends at byte {} and the file at byte {}; its "
                  "intact part was read",
                  at, end, file_.size()));
}

void BagReader::check_end() {
  if (!index_at_) return warn("it has no bag header; its intact part was read");
  if (*index_at_ == 0) return warn("it was never closed (it has no index); its intact part was read");
  if (!cut_short_ && *index_at_ >= file_.size()) {
    warn(
        fmt::format("it is cut short: its index should be at byte {} and the file ends at byte {}; its "
                    "intact part was read",
                    *index_at_, file_.size()));
  }
}

Result<std::vector<std::string>> BagReader::finish() {
  check_end();
  if (warnings_left_out_ > 0) {
    warnings_.push_back(fmt::format("{} more places are damaged", warnings_left_out_));
  }
  if (orphans_ > 1) warnings_.push_back(fmt::format("{} messages belong to no connection", orphans_));
  return std::move(warnings_);
}

Result<std::vector<std::string>> BagReader::read(const Job& job) {
  file_.seek(kBagMagic.size());
  Header header;
  while (read_header(header)) {
    if (auto error = read_record(header)) return tl::unexpected(std::move(*error));
    const std::uint64_t end = header.data_at + header.data_bytes;
    if (end > file_.size()) {
      warn_of_end(header.at, end);
      break;
    }
    file_.seek(end);
    job.report("reading", static_cast<double>(end) / static_cast<double>(file_.size()));
    if (job.cancelled())
      return failure(ExitCode::kInterrupted, fmt::format("{}: reading was interrupted", name_));
  }
  return finish();
}

}  // namespace

Result<std::vector<std::string>> read_ros1_bag(const std::filesystem::path& path, const BagVisitor& visit,
                                               const Job& job, const BagConnectionVisitor& visit_connection) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::array<std::byte, kBagMagic.size()> magic{};
  file->read(magic);
  if (as_text(magic) != kBagMagic) {
    return unreadable(fmt::format("{}: byte 0 does not begin a ROS 1 bag of format 2.0", path.string()));
  }
  return BagReader(*file, path.string(), visit, visit_connection).read(job);
}

}  // namespace sweepscope
