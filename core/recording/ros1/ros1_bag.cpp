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

/// Whether `bytes` begin with the header of a record.
bool begins_record(std::span<const std::byte> bytes) {
  constexpr std::size_t kMinHeader_bytes = 8, kMaxLikelyHeader_bytes = 4096;
  if (bytes.size() < 4 + kMinHeader_bytes) return false;
  const std::size_t length = load<std::uint32_t>(bytes);
  if (length < kMinHeader_bytes || length > std::min(kMaxLikelyHeader_bytes, bytes.size() - 4)) return false;
  const auto fields = BagFields::parse(bytes.subspan(4, length));
  return fields && fits_its_op(*fields);
}

std::optional<std::size_t> find_record(std::span<const std::byte> bytes, std::size_t from) {
  for (std::size_t at = from; at < bytes.size(); ++at)
    if (begins_record(bytes.subspan(at))) return at;
  return std::nullopt;
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
    std::uint64_t held_bytes = 0;  // of the data: up to the file's end, or to what the index places behind it
    std::uint64_t end() const { return data_at + data_bytes; }
    bool whole() const { return held_bytes == data_bytes; }
  };
  /// A part of the file of which nothing was used.
  struct Lost {
    std::string why;
    BagPlace end;
    std::optional<std::int64_t> before_ns;  // the last message before it
  };

  bool read_header(Header& header);
  std::span<const std::byte> read_data(const Header& header);
  std::optional<Error> read_record(const Header& header);
  std::optional<Error> read_bag_header(const BagFields& fields);
  std::optional<Error> read_chunk(const Header& header, const BagFields& fields);
  std::optional<Error> read_unpacked(std::span<const std::byte> chunk, const Header& header, bool whole);
  BagPlace place_in(const Header& chunk, std::size_t byte) const;
  void add_connection(const BagFields& fields, std::span<const std::byte> data, const BagPlace& place);
  void describe(BagConnection connection, const BagPlace& place);
  std::optional<Error> visit_message(const BagFields& fields, std::span<const std::byte> data,
                                     const BagPlace& place);
  bool check_op(const BagFields& fields, const BagPlace& place);
  void learn_from_index();
  std::optional<std::uint64_t> indexed_behind(std::uint64_t at) const;
  bool record_at(std::uint64_t at);
  std::uint64_t search(std::uint64_t from);
  bool go_on_behind(std::uint64_t damage);
  void lose(const std::string& why, const BagPlace& end);
  void warn_of_lost(std::optional<std::int64_t> after_ns);
  bool pass_wrong_end(const Header& header);
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
  bool empty_ = false;                            // as claimed
  std::vector<std::uint64_t> chunks_;             // where the index places them, ascending
  std::string problem_;                           // of the last header
  std::optional<Lost> lost_;                      // since the last message
  std::optional<std::int64_t> first_ns_, last_ns_;
  bool cut_short_ = false;
  bool ends_whole_ = false;  // its index lies where it should, up to the file's end: it is not cut short
  std::size_t orphans_ = 0;  // messages of connections that nothing describes
  static constexpr std::size_t kMaxWarnings = 20;
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

/// A record's header and the length of its data. False at the end of what can be read; why is in `problem_`.
bool BagReader::read_header(Header& header) {
  header.at = file_.position();
  std::array<std::byte, 4> length;
  problem_ = "it is cut short in the record";
  if (file_.read(length) != length.size()) return false;
  const std::uint64_t header_bytes = load<std::uint32_t>(length);
  if (header_bytes <= kMaxHeader_bytes && header_bytes > file_.left()) return false;
  problem_ = "there is no record";
  if (header_bytes > kMaxHeader_bytes) return false;
  header.bytes.resize(header_bytes);
  file_.read(header.bytes);
  const auto fields = BagFields::parse(header.bytes);
  if (!fields || !fields->find("op")) return false;
  problem_ = "it is cut short in the record";
  if (file_.read(length) != length.size()) return false;
  header.data_bytes = load<std::uint32_t>(length);
  header.data_at = file_.position();
  header.held_bytes = std::min(header.data_bytes, file_.left());
  if (const auto next = indexed_behind(header.at); next && header.end() > *next && record_at(*next))
    header.held_bytes = *next - std::min(*next, header.data_at);
  file_.seek(header.data_at);
  return true;
}

/// The data of a record, as far as the file holds it.
std::span<const std::byte> BagReader::read_data(const Header& header) {
  if (packed_.size() < header.held_bytes) packed_.resize(header.held_bytes);
  const std::span<std::byte> data = std::span(packed_).first(header.held_bytes);
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
  if (!header.whole()) return std::nullopt;  // which the caller reports
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
  empty_ =
      fields.number<std::uint32_t>("conn_count") == 0U && fields.number<std::uint32_t>("chunk_count") == 0U;
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

/// A sound index describes every connection again, which helps where the chunk that introduced one is
/// damaged, and places every chunk.
void BagReader::learn_from_index() {
  if (*index_at_ == 0 || *index_at_ >= file_.size()) return;
  const std::uint64_t here = file_.position();
  const std::size_t warnings_before = warnings_.size(), left_out_before = warnings_left_out_;
  file_.seek(*index_at_);
  std::vector<std::uint64_t> chunks;
  Header header;
  while (file_.left() > 0 && read_header(header) && header.whole()) {
    const BagFields fields = *BagFields::parse(header.bytes);
    if (fields.op() == BagOp::kConnection && header.data_bytes <= kMaxHeader_bytes)
      add_connection(fields, read_data(header), {header.at, std::nullopt});
    if (const auto at = fields.number<std::uint64_t>("chunk_pos"); at && fields.op() == BagOp::kChunkInfo)
      chunks.push_back(*at);
    file_.seek(header.end());
  }
  ends_whole_ = file_.left() == 0;
  std::ranges::sort(chunks);
  chunks_ = std::move(chunks);
  // What is wrong there is said when the reading comes there.
  warnings_.resize(warnings_before);
  warnings_left_out_ = left_out_before;
  file_.seek(here);
}

/// Where the next chunk or else the index lies, as the index says.
std::optional<std::uint64_t> BagReader::indexed_behind(std::uint64_t at) const {
  const auto chunk = std::ranges::upper_bound(chunks_, at);
  const std::uint64_t next = chunk != chunks_.end() ? *chunk : ends_whole_ ? *index_at_ : 0;
  return next > at && next < file_.size() ? std::optional(next) : std::nullopt;
}

bool BagReader::record_at(std::uint64_t at) {
  std::array<std::byte, 4096> bytes;
  file_.seek(at);
  return begins_record(std::span(bytes).first(file_.read(bytes)));
}

/// The next place at which a record begins; the end of the file where there is none.
std::uint64_t BagReader::search(std::uint64_t from) {
  constexpr std::size_t kFirstBlock_bytes = 8192, kLargestBlock_bytes = std::size_t{1} << 20,
                        kOverlap_bytes = 4200;
  std::vector<std::byte> block;
  for (std::size_t bytes = kFirstBlock_bytes; from < file_.size(); from += block.size() - kOverlap_bytes) {
    file_.seek(from);
    block.resize(bytes);
    block.resize(file_.read(block));
    if (const auto found = find_record(block, 0)) return from + *found;
    if (block.size() <= kOverlap_bytes) break;
    bytes = std::min(2 * bytes, kLargestBlock_bytes);
  }
  return file_.size();
}

/// Goes to the next record after one that cannot be read; false where there is none.
bool BagReader::go_on_behind(std::uint64_t damage) {
  const bool cut = problem_.starts_with("it is cut");
  const std::uint64_t next = search(damage + 1);
  const bool found = next < file_.size();
  if (cut && (found || ends_whole_)) problem_ = "a length is damaged in the record";
  cut_short_ |= cut && !found;
  lose(fmt::format("{} at byte {}", problem_, damage), {next, std::nullopt});
  file_.seek(next);
  return found;
}

/// Parts between which there is no message are one.
void BagReader::lose(const std::string& why, const BagPlace& end) {
  if (!lost_) lost_ = Lost{why, end, last_ns_};
  lost_->end = end;
}

void BagReader::warn_of_lost(std::optional<std::int64_t> after_ns) {
  if (!lost_) return;
  const auto since_first_s = [&](std::int64_t ns) { return static_cast<double>(ns - *first_ns_) * 1e-9; };
  const auto& before_ns = lost_->before_ns;
  const std::string times =
      before_ns && after_ns ? fmt::format(", from {:.3f} s to {:.3f} s after the first message",
                                          since_first_s(*before_ns), since_first_s(*after_ns))
      : before_ns ? fmt::format(", from {:.3f} s after the first message on", since_first_s(*before_ns))
                  : "";
  warn(fmt::format("{}: nothing up to {} could be used{}", lost_->why, lost_->end.text(), times));
  lost_.reset();
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
  const bool whole = header.whole();
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
  return read_unpacked(unpacked.bytes, header, whole && unpacked.problem.empty());
}

/// A place in a chunk: in the file, if the chunk lies there as it is.
BagPlace BagReader::place_in(const Header& chunk, std::size_t byte) const {
  if (compression_ == Compression::kNone) return {chunk.data_at + byte, std::nullopt};
  return {chunk.at, byte};
}

/// The records of a chunk. At the end of one that is not whole, what is missing is reported by the caller.
std::optional<Error> BagReader::read_unpacked(std::span<const std::byte> chunk, const Header& header,
                                              bool whole) {
  std::size_t at = 0;
  while (at < chunk.size()) {
    const BagPlace place{header.at, at};
    const auto record = parse_record(chunk.subspan(at));
    if (!record || !record->fields.find("op")) {
      const auto next = find_record(chunk, at + 1);
      if (whole || next)
        lose(fmt::format("there is no complete record at {}", place_in(header, at).text()),
             place_in(header, next.value_or(chunk.size())));
      if (!next) return std::nullopt;
      at = *next;
      continue;
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
  warn_of_lost(*receive_ns);
  if (!first_ns_) first_ns_ = receive_ns;
  last_ns_ = receive_ns;
  return visit_({connection->second, *receive_ns, data, place, compression_});
}

/// Of a record that claims to end behind what the file holds of it; false where that is the file's end.
bool BagReader::pass_wrong_end(const Header& header) {
  const std::uint64_t next = header.data_at + header.held_bytes;
  cut_short_ |= next == file_.size();
  if (next == file_.size()) {
    warn(
        fmt::format("it is cut short: the record at byte {} ends at byte {} and the file at byte {}; its "
                    "intact part was read",
                    header.at, header.end(), file_.size()));
    return false;
  }
  warn(
      fmt::format("the length of the record at byte {} is damaged: it would end at byte {}, and the next "
                  "record begins at byte {}",
                  header.at, header.end(), next));
  file_.seek(next);
  return true;
}

void BagReader::check_end() {
  if (!index_at_) return warn("it has no bag header; its intact part was read");
  if (*index_at_ == 0) return warn("it was never closed (it has no index); its intact part was read");
  const bool empty = empty_ && *index_at_ == file_.size();
  if (!cut_short_ && !empty && *index_at_ >= file_.size()) {
    warn(
        fmt::format("it is cut short: its index should be at byte {} and the file ends at byte {}; its "
                    "intact part was read",
                    *index_at_, file_.size()));
  }
}

Result<std::vector<std::string>> BagReader::finish() {
  warn_of_lost(std::nullopt);
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
  while (file_.left() > 0) {
    job.report("reading", static_cast<double>(file_.position()) / static_cast<double>(file_.size()));
    if (job.cancelled())
      return failure(ExitCode::kInterrupted, fmt::format("{}: reading was interrupted", name_));
    if (!read_header(header)) {
      if (!go_on_behind(header.at)) break;
      continue;
    }
    if (auto error = read_record(header)) return tl::unexpected(std::move(*error));
    if (header.whole())
      file_.seek(header.end());
    else if (!pass_wrong_end(header))
      break;
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
