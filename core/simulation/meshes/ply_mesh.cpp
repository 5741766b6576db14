#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/io/point_records.hpp"
#include "core/io/text_cursor.hpp"
#include "core/simulation/meshes/mesh_file.hpp"

namespace sweepscope::simulation {
namespace {

constexpr std::size_t kLongestHeader = 65536;

struct Property {
  std::string name;
  ScalarType type = ScalarType::kF32;
  std::optional<ScalarType> length_type;  // of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
  bool ended = false;
};

/// What is wrong with the line, or empty.
std::string take_element(TextCursor& words, Header& header) {
  const auto element = words.next_word();
  const auto count = words.next_number();
  if (!element || !count) return "an element needs a name and a number";
  if (!(*count >= 0 && *count <= 4e9 && *count == std::floor(*count)))
    return fmt::format("the number of the element {} is not valid", *element);
  header.elements.push_back({std::string(*element), static_cast<std::size_t>(*count), {}});
  return {};
}

std::string take_property(TextCursor& words, Header& header) {
  if (header.elements.empty()) return "a property before the first element";
  Property property;
  auto type_word = words.next_word();
  if (type_word == "list") {
    const auto length_word = words.next_word();
    property.length_type = length_word ? ply_scalar_type(*length_word) : std::nullopt;
    if (!property.length_type) return "a list needs a known type of its length";
    type_word = words.next_word();
  }
  const auto type = type_word ? ply_scalar_type(*type_word) : std::nullopt;
  const auto property_name = words.next_word();
  if (!type || !property_name) return "a property needs a known type and a name";
  property.type = *type;
  property.name = *property_name;
  header.elements.back().properties.push_back(std::move(property));
  return {};
}

std::string take_header_line(std::string_view line, Header& header) {
  TextCursor words(line);
  const auto key = words.next_word();
  if (!key || key == "comment" || key == "obj_info" || key == "ply") return {};
  if (key == "element") return take_element(words, header);
  if (key == "property") return take_property(words, header);
  if (key == "format")
    header.format = words.next_word().value_or("");
  else if (key == "end_header")
    header.ended = true;
  else
    return fmt::format("\"{}\" is not a keyword of a PLY header", key->substr(0, 40));
  return {};
}

/// The numbers of the body, one after another.
class Numbers {
 public:
  virtual ~Numbers() = default;
  /// Before each instance of an element.
  virtual void begin() {}
  virtual std::optional<double> next(ScalarType type) = 0;
  /// Where the last number was, for a sentence.
  virtual std::string place(const Element& element, std::size_t number) const = 0;
};

class AsciiNumbers : public Numbers {
 public:
  AsciiNumbers(std::string_view body, std::size_t lines_before) : lines_(body), lines_before_(lines_before) {}

  void begin() override {
    while (const auto line = lines_.next_line()) {
      words_ = TextCursor(*line);
      if (line->find_first_not_of(" \t") != line->npos) return;
    }
    words_ = TextCursor(std::string_view());
  }
  std::optional<double> next(ScalarType) override { return words_.next_number(); }
  std::string place(const Element&, std::size_t) const override {
    return fmt::format("line {}", lines_before_ + lines_.line());
  }

 private:
  TextCursor lines_, words_{std::string_view()};
  std::size_t lines_before_;
};

class BinaryNumbers : public Numbers {
 public:
  BinaryNumbers(std::string_view body, bool big_endian) : body_(body), big_endian_(big_endian) {}

  std::optional<double> next(ScalarType type) override {
    const std::size_t size = size_of(type);
    if (size > body_.size() - at_) return std::nullopt;
    char bytes[8] = {};
    std::copy_n(body_.data() + at_, size, bytes);
    if (big_endian_) std::reverse(bytes, bytes + size);
    at_ += size;
    return load_scalar(type, bytes);
  }
  std::string place(const Element& element, std::size_t number) const override {
    return fmt::format("{} {} (counted from 0)", element.name, number);
  }

 private:
  std::string_view body_;
  bool big_endian_;
  std::size_t at_ = 0;
};

/// One vertex or face of the body, or another element's instance: what is wrong with it, or empty.
class Taker {
 public:
  Taker(Numbers& numbers, MeshBuilder& builder) : numbers_(numbers), builder_(builder) {}

  std::string take(const Element& element) {
    numbers_.begin();
    Vector3d p_m = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    list_.clear();
    for (const Property& property : element.properties) {
      if (property.length_type) {
        if (!take_list(property)) return "the file ends, or a list is not numbers";
        continue;
      }
      const auto number = numbers_.next(property.type);
      if (!number) return "the file ends, or there are too few numbers";
      if (property.name == "x") p_m.x() = *number;
      if (property.name == "y") p_m.y() = *number;
      if (property.name == "z") p_m.z() = *number;
    }
    if (element.name == "vertex") return builder_.add_vertex(p_m);
    if (element.name == "face") return builder_.add_face(list_);
    return {};
  }

 private:
  bool take_list(const Property& property) {
    const auto length = numbers_.next(*property.length_type);
    if (!length || !(*length >= 0) || *length != std::floor(*length)) return false;
    const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
    for (double i = 0; i < *length; ++i) {
      const auto number = numbers_.next(property.type);
      if (!number) return false;
      // What is no index becomes one that is out of range.
      const bool whole = std::abs(*number) < 9e15 && *number == std::floor(*number);
      if (corners) list_.push_back(whole ? static_cast<std::int64_t>(*number) : -1);
    }
    return true;
  }

  Numbers& numbers_;
  MeshBuilder& builder_;
  std::vector<std::int64_t> list_;  // a face's corners
};

/// What the header lacks, or empty.
std::string missing(const Header& header) {
  const auto at = [&](std::string_view name) {
    return std::find_if(header.elements.begin(), header.elements.end(),
                        [&](const Element& element) { return element.name == name; });
  };
  const auto vertex = at("vertex"), face = at("face");
  if (vertex == header.elements.end()) return "the PLY header names no element vertex";
  if (face == header.elements.end()) return "the PLY header names no element face: a cloud is not a mesh";
  if (face < vertex) return "the element vertex must come before the element face";
  for (const std::string_view name : {"x", "y", "z"})
    if (std::none_of(vertex->properties.begin(), vertex->properties.end(),
                     [&](const Property& p) { return p.name == name && !p.length_type; }))
      return fmt::format("the element vertex has no property {}", name);
  if (std::none_of(face->properties.begin(), face->properties.end(), [](const Property& p) {
        return p.length_type && (p.name == "vertex_indices" || p.name == "vertex_index");
      }))
    return "the element face has no list vertex_indices";
  return {};
}

Result<Header> read_header(TextCursor& cursor, std::string_view name) {
  Header header;
  if (cursor.next_line() != "ply") return unreadable(fmt::format("{}: is not a PLY file", name));
  while (!header.ended) {
    const auto line = cursor.next_line();
    if (!line || cursor.position() > kLongestHeader)
      return unreadable(fmt::format("{}: the PLY header has no end_header line", name));
    if (const std::string wrong = take_header_line(*line, header); !wrong.empty())
      return unreadable(fmt::format("{}: line {}: {}", name, cursor.line(), wrong));
  }
  if (const std::string lack = missing(header); !lack.empty())
    return unreadable(fmt::format("{}: {}", name, lack));
  return header;
}

std::unique_ptr<Numbers> numbers_of(const Header& header, std::string_view body, std::size_t lines_before) {
  if (header.format == "ascii") return std::make_unique<AsciiNumbers>(body, lines_before);
  if (header.format == "binary_little_endian") return std::make_unique<BinaryNumbers>(body, false);
  if (header.format == "binary_big_endian") return std::make_unique<BinaryNumbers>(body, true);
  return nullptr;
}

}  // namespace

Result<Mesh> parse_ply_mesh(std::string_view bytes, std::string_view name) {
  TextCursor cursor(bytes);
  const auto header = read_header(cursor, name);
  if (!header) return tl::unexpected(header.error());
  const auto numbers = numbers_of(*header, bytes.substr(cursor.position()), cursor.line());
  if (!numbers)
    return unreadable(
        fmt::format("{}: PLY format {} is not read, only ascii, binary_little_endian and binary_big_endian",
                    name, header->format));
  MeshBuilder builder;
  Taker taker(*numbers, builder);
  for (const Element& element : header->elements) {
    if (element.properties.empty()) continue;
    for (std::size_t i = 0; i < element.count; ++i)
      if (const std::string wrong = taker.take(element); !wrong.empty())
        return unreadable(fmt::format("{}: {}: {}", name, numbers->place(element, i), wrong));
  }
  return builder.finish(name);
}

}  // namespace sweepscope::simulation
