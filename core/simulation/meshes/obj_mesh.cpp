#include <fmt/format.h>

#include <charconv>

#include "core/io/text_cursor.hpp"
#include "core/simulation/meshes/mesh_file.hpp"

namespace sweepscope::simulation {
namespace {

/// What is wrong with the line, or empty.
std::string take_vertex(TextCursor& words, MeshBuilder& builder) {
  Vector3d p_m;
  for (double& coordinate : p_m) {
    const auto number = words.next_number();
    if (!number) return "a vertex needs three numbers";
    coordinate = *number;
  }
  return builder.add_vertex(p_m);
}

std::string take_face(TextCursor& words, MeshBuilder& builder) {
  std::vector<std::int64_t> corners;
  while (const auto word = words.next_word()) {
    const std::string_view index = word->substr(0, word->find('/'));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), number);
    if (error != std::errc() || end != index.data() + index.size() || number == 0)
      return fmt::format("\"{}\" is not a corner of a face", word->substr(0, 40));
    // Counted from 1, or back from the last vertex so far.
    const auto vertices = static_cast<std::int64_t>(builder.vertices());
    if (number < -vertices)
      return fmt::format("a face counts back to {}, but there are {} vertices so far", number, vertices);
    corners.push_back(number > 0 ? number - 1 : vertices + number);
  }
  return builder.add_face(corners);
}

}  // namespace

Result<Mesh> parse_obj_mesh(std::string_view text, std::string_view name) {
  MeshBuilder builder;
  TextCursor lines(text);
  while (const auto line = lines.next_line()) {
    TextCursor words(*line);
    const auto key = words.next_word();
    std::string wrong;
    if (key == "v") wrong = take_vertex(words, builder);
    if (key == "f") wrong = take_face(words, builder);
    if (!wrong.empty()) return unreadable(fmt::format("{}: line {}: {}", name, lines.line(), wrong));
  }
  return builder.finish(name);
}

}  // namespace sweepscope::simulation
