#include "core/io/content_hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <memory>
#include <span>
#include <vector>

#include "core/recording/input_file.hpp"

namespace sweepscope {
namespace {

std::string digits_of(XXH128_hash_t hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string content_hash(std::string_view bytes) {
  return digits_of(XXH3_128bits(bytes.data(), bytes.size()));
}

Result<std::string> file_content_hash(const std::filesystem::path& path) {
  constexpr std::size_t kPiece_bytes = std::size_t{1} << 20;
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::vector<std::byte> piece(kPiece_bytes);
  while (const std::size_t got = file->read(std::span(piece))) {
    XXH3_128bits_update(state.get(), piece.data(), got);
  }
  return digits_of(XXH3_128bits_digest(state.get()));
}

}  // namespace sweepscope
