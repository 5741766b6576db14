#include "core/results/sealed_line.hpp"

#include <fmt/format.h>

#include "core/io/content_hash.hpp"

namespace sweepscope {
namespace {

/// What ends a line: the hash of the bytes before it.
std::string seal_of(std::string_view bytes) {
  return fmt::format(",\"hash\":\"{}\"}}", content_hash(bytes));
}

}  // namespace

std::string sealed_line(std::string_view object) {
  const std::string_view bytes = object.substr(0, object.size() - 1);  // the seal closes it
  return fmt::format("{}{}\n", bytes, seal_of(bytes));
}

bool is_sound_line(std::string_view line) {
  static const std::size_t seal_bytes = seal_of("").size();
  if (line.size() < seal_bytes) return false;
  const std::string_view bytes = line.substr(0, line.size() - seal_bytes);
  return line.substr(bytes.size()) == seal_of(bytes);
}

}  // namespace sweepscope
