#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "core/io/point_records.hpp"
#include "core/io/text_cursor.hpp"

namespace sweepscope {
namespace {

/// Unpacks LZF data, as in compressed PCD files. Nothing where the data are broken or do not unpack to
/// exactly `unpacked_bytes`.
std::optional<std::string> lzf_unpack(std::string_view packed, std::size_t unpacked_bytes) {
  // Three bytes unpack to 264 at the most, so a size beyond that is broken and not worth allocating.
  if (unpacked_bytes / 88 > packed.size()) return std::nullopt;
  std::string out;
  out.reserve(unpacked_bytes);
  std::size_t in = 0;
  const auto next = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(packed[in++])); };
  while (in < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {  // a run of literal bytes
      const std::size_t length = control + 1;
      if (length > packed.size() - in || length > unpacked_bytes - out.size()) return std::nullopt;
      out.append(packed.substr(in, length));
      in += length;
      continue;
    }
    std::size_t length = control >> 5;  // a copy of earlier output, which may overlap what it writes
    if (packed.size() - in < (length == 7 ? 2U : 1U)) return std::nullopt;
    if (length == 7) length += next();
    length += 2;
    const std::size_t distance = ((control & 31) << 8) + next() + 1;
    if (distance > out.size() || length > unpacked_bytes - out.size()) return std::nullopt;
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - distance]);
  }
  if (out.size() != unpacked_bytes) return std::nullopt;
  return out;
}

constexpr std::size_t kMaxPcdFields = 128;
constexpr double kMaxCount = 4096;

struct PcdHeader {
  PointLayout layout;
  std::vector<double> sizes, counts;
  std::vector<std::string> types;
  std::optional<double> width, height, points;
  std::string data;
  std::size_t bytes = 0, lines = 0;  // of the header itself
};

std::vector<std::string> words_of(TextCursor& cursor) {
  std::vector<std::string> words;
  while (const auto word = cursor.next_word()) words.emplace_back(*word);
  return words;
}

std::vector<double> numbers_of(TextCursor& cursor) {
  std::vector<double> numbers;
  while (const auto number = cursor.next_number()) numbers.push_back(*number);
  return numbers;
}

void take_header_line(std::string_view line, PcdHeader& header) {
  TextCursor words(line);
  const auto key = words.next_word();
  if (!key || key->front() == '#') return;
  if (*key == "FIELDS" || *key == "COLUMNS") {
    for (std::string& field : words_of(words)) header.layout.fields.push_back({std::move(field)});
  } else if (*key == "SIZE") {
    header.sizes = numbers_of(words);
  } else if (*key == "TYPE") {
    header.types = words_of(words);
  } else if (*key == "COUNT") {
    header.counts = numbers_of(words);
  } else if (*key == "WIDTH") {
    header.width = words.next_number();
  } else if (*key == "HEIGHT") {
    header.height = words.next_number();
  } else if (*key == "POINTS") {
    header.points = words.next_number();
  } else if (*key == "DATA") {
    header.data = words.next_word().value_or("");
  }
}

std::optional<ScalarType> scalar_type(std::string_view letter, double size) {
  struct Row {
    char letter;
    double size;
    ScalarType type;
  };
  static constexpr Row kRows[] = {{'I', 1, ScalarType::kI8},  {'U', 1, ScalarType::kU8},
                                  {'I', 2, ScalarType::kI16}, {'U', 2, ScalarType::kU16},
                                  {'I', 4, ScalarType::kI32}, {'U', 4, ScalarType::kU32},
                                  {'I', 8, ScalarType::kI64}, {'U', 8, ScalarType::kU64},
                                  {'F', 4, ScalarType::kF32}, {'F', 8, ScalarType::kF64}};
  for (const Row& row : kRows) {
    if (letter.size() == 1 && letter[0] == row.letter && size == row.size) return row.type;
  }
  return std::nullopt;
}

Result<void> complete_fields(PcdHeader& header, std::string_view name) {
  auto& fields = header.layout.fields;
  if (fields.empty() || fields.size() > kMaxPcdFields) {
    return unreadable(fmt::format("{}: the PCD header names {} fields; 1 to {} are read", name, fields.size(),
                                  kMaxPcdFields));
  }
  if (header.counts.empty()) header.counts.assign(fields.size(), 1);
  if (header.sizes.size() != fields.size() || header.types.size() != fields.size() ||
      header.counts.size() != fields.size()) {
    return unreadable(
        fmt::format("{}: FIELDS, SIZE, TYPE and COUNT of the PCD header differ in length", name));
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto type = scalar_type(header.types[f], header.sizes[f]);
    const double count = header.counts[f];
    if (!type || !(count >= 1 && count <= kMaxCount) || count != std::floor(count)) {
      return unreadable(
          fmt::format("{}: field {} of the PCD header has TYPE {}, SIZE {}, COUNT {}, which is not valid",
                      name, fields[f].name, header.types[f], header.sizes[f], count));
    }
    fields[f].type = *type;
    fields[f].count = static_cast<std::size_t>(count);
  }
  return {};
}

Result<PcdHeader> parse_header(std::string_view bytes, std::string_view name) {
  PcdHeader header;
  TextCursor cursor(bytes);
  while (header.data.empty()) {
    const auto line = cursor.next_line();
    if (!line || cursor.position() > 65536) {
      return unreadable(fmt::format("{}: the PCD header has no DATA line", name));
    }
    take_header_line(*line, header);
  }
  header.bytes = cursor.position();
  header.lines = cursor.line();
  if (!header.points && header.width && header.height) header.points = *header.width * *header.height;
  if (!header.points || !(*header.points >= 0 && *header.points <= 4e9)) {
    return unreadable(fmt::format("{}: the PCD header has no valid number of POINTS", name));
  }
  return complete_fields(header, name).map([&] { return header; });
}

Result<MapCloud::Ptr> read_compressed(std::string_view body, const PcdHeader& header, std::size_t points,
                                      std::string_view name) {
  std::uint32_t packed_bytes = 0, unpacked_bytes = 0;
  if (body.size() < 8) return unreadable(fmt::format("{}: the file ends before its compressed points", name));
  std::memcpy(&packed_bytes, body.data(), 4);
  std::memcpy(&unpacked_bytes, body.data() + 4, 4);
  body.remove_prefix(8);
  if (packed_bytes > body.size()) {
    return unreadable(fmt::format("{}: the header promises {} bytes of compressed points, the file holds {}",
                                  name, packed_bytes, body.size()));
  }
  if (unpacked_bytes != points * header.layout.record_bytes()) {
    return unreadable(
        fmt::format("{}: {} points of {} bytes do not fit the {} bytes that the header promises", name,
                    points, header.layout.record_bytes(), unpacked_bytes));
  }
  const auto unpacked = lzf_unpack(body.substr(0, packed_bytes), unpacked_bytes);
  if (!unpacked) return unreadable(fmt::format("{}: the compressed points are damaged", name));
  return read_binary_points(columns_of(*unpacked, header.layout, points), header.layout, points, name);
}

}  // namespace

Result<MapCloud::Ptr> parse_pcd(std::string_view bytes, std::string_view name) {
  const Result<PcdHeader> header = parse_header(bytes, name);
  if (!header) return tl::unexpected(header.error());
  const std::string_view body = bytes.substr(header->bytes);
  const auto points = static_cast<std::size_t>(*header->points);
  if (header->data == "ascii") return read_ascii_points(body, header->layout, points, header->lines, name);
  if (header->data == "binary_compressed") return read_compressed(body, *header, points, name);
  if (header->data != "binary") {
    return unreadable(fmt::format("{}: line {}: DATA {} is not known", name, header->lines, header->data));
  }
  if (points > body.size() / header->layout.record_bytes()) {
    return unreadable(
        fmt::format("{}: the header promises {} points of {} bytes, the file holds {} bytes of them", name,
                    points, header->layout.record_bytes(), body.size()));
  }
  return read_binary_points(rows_of(body, header->layout), header->layout, points, name);
}

}  // namespace sweepscope
