#include <fmt/format.h>

#include <cmath>

#include "core/io/point_records.hpp"
#include "core/io/text_cursor.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMaxPlyFields = 128;

struct PlyHeader {
  std::string format;
  PointLayout layout;  // of the element vertex
  double points = -1;
  std::size_t elements = 0;
  bool in_vertex = false, ended = false;
};

/// Empty, or what is wrong with the line.
std::string take_element(TextCursor& words, PlyHeader& header) {
  const auto element = words.next_word();
  const auto count = words.next_number();
  if (!element || !count) return "an element needs a name and a number";
  header.in_vertex = *element == "vertex";
  if (header.in_vertex) {
    if (header.elements > 0) return "the element vertex must come first";
    if (!(*count >= 0 && *count <= 4e9)) return "the number of vertices is not valid";
    header.points = std::floor(*count);
  }
  ++header.elements;
  return {};
}

std::string take_property(TextCursor& words, PlyHeader& header) {
  if (!header.in_vertex) return {};
  const auto type_word = words.next_word();
  const auto field = words.next_word();
  if (type_word && *type_word == "list") return "a list in the element vertex cannot be read";
  const auto type = type_word ? ply_scalar_type(*type_word) : std::nullopt;
  if (!type || !field) return "a property needs a known type and a name";
  if (header.layout.fields.size() == kMaxPlyFields) return "the vertices have too many properties";
  header.layout.fields.push_back({std::string(*field), *type});
  return {};
}

std::string take_header_line(std::string_view line, PlyHeader& header) {
  TextCursor words(line);
  const auto key = words.next_word();
  if (!key || *key == "comment" || *key == "obj_info" || *key == "ply") return {};
  if (*key == "format")
    header.format = words.next_word().value_or("");
  else if (*key == "element")
    return take_element(words, header);
  else if (*key == "property")
    return take_property(words, header);
  else if (*key == "end_header")
    header.ended = true;
  else
    return fmt::format("\"{}\" is not a keyword of a PLY header", key->substr(0, 40));
  return {};
}

}  // namespace

std::optional<ScalarType> ply_scalar_type(std::string_view word) {
  struct Row {
    std::string_view word, sized_word;
    ScalarType type;
  };
  static constexpr Row kRows[] = {
      {"char", "int8", ScalarType::kI8},      {"uchar", "uint8", ScalarType::kU8},
      {"short", "int16", ScalarType::kI16},   {"ushort", "uint16", ScalarType::kU16},
      {"int", "int32", ScalarType::kI32},     {"uint", "uint32", ScalarType::kU32},
      {"float", "float32", ScalarType::kF32}, {"double", "float64", ScalarType::kF64}};
  for (const Row& row : kRows) {
    if (word == row.word || word == row.sized_word) return row.type;
  }
  return std::nullopt;
}

Result<MapCloud::Ptr> parse_ply(std::string_view bytes, std::string_view name) {
  PlyHeader header;
  TextCursor cursor(bytes);
  while (!header.ended) {
    const auto line = cursor.next_line();
    if (!line || cursor.position() > 65536) {
      return unreadable(fmt::format("{}: the PLY header has no end_header line", name));
    }
    if (const std::string wrong = take_header_line(*line, header); !wrong.empty()) {
      return unreadable(fmt::format("{}: line {}: {}", name, cursor.line(), wrong));
    }
  }
  if (header.points < 0 || header.layout.fields.empty()) {
    return unreadable(fmt::format("{}: the PLY header names no element vertex with properties", name));
  }
  const std::string_view body = bytes.substr(cursor.position());
  const auto points = static_cast<std::size_t>(header.points);
  if (header.format == "ascii") return read_ascii_points(body, header.layout, points, cursor.line(), name);
  if (header.format != "binary_little_endian") {
    return unreadable(fmt::format("{}: PLY format {} is not read, only ascii and binary_little_endian", name,
                                  header.format));
  }
  if (points > body.size() / header.layout.record_bytes()) {
    return unreadable(
        fmt::format("{}: the header promises {} points of {} bytes, the file holds {} bytes of them", name,
                    points, header.layout.record_bytes(), body.size()));
  }
  return read_binary_points(rows_of(body, header.layout), header.layout, points, name);
}

}  // namespace sweepscope
