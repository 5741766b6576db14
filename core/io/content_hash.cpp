#include "core/io/content_hash.hpp"

#include <fmt/format.h>
#include <sys/auxv.h>
#include <xxhash.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/io/input_file.hpp"

namespace sweepscope {
namespace {

std::string digits_of(XXH128_hash_t hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

Result<std::string> folder_content_hash(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error) && !entry->path().filename().empty()) files.push_back(entry->path());
  if (error) return unreadable(fmt::format("{}: {}", folder.string(), error.message()));
  std::ranges::sort(files);
  std::string lines;
  for (const fs::path& file : files) {
    // An empty file is no input, and part of the folder all the same.
    const bool empty = fs::file_size(file, error) == 0;
    const auto hash = empty ? Result<std::string>("empty") : file_content_hash(file);
    if (!hash) return hash;
    lines += fmt::format("{} {}\n", *hash, file.filename().string());
  }
  return content_hash(lines);
}

}  // namespace

std::string content_hash(std::string_view bytes) {
  return digits_of(XXH3_128bits(bytes.data(), bytes.size()));
}

Result<std::string> file_content_hash(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return folder_content_hash(path);
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

Result<std::string> recording_content_hash(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error)) return file_content_hash(path);
  std::vector<fs::path> files;
  for (auto entry = fs::recursive_directory_iterator(path, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file(error)) files.push_back(entry->path());
  if (error) return unreadable(fmt::format("{}: {}", path.string(), error.message()));
  std::sort(files.begin(), files.end());
  std::string all;
  for (const fs::path& file : files) {
    const bool empty = fs::is_empty(file, error);
    const auto hash = empty ? content_hash("") : file_content_hash(file);
    if (!hash) return hash;
    all += file.lexically_relative(path).string() + '\0' + *hash + '\0';
  }
  return content_hash(all);
}

Result<std::string> program_content_hash() {
  static const Result<std::string> hash = [] {
    std::error_code ignored;
    const std::filesystem::path running = "/proc/self/exe";
    if (std::filesystem::exists(running, ignored)) return file_content_hash(running);
    // A bare chroot has no /proc: the path that the program was begun with.
    return file_content_hash(
        reinterpret_cast<const char*>(getauxval(AT_EXECFN)));  // NOLINT(performance-no-int-to-ptr)
  }();
  return hash;
}

}  // namespace sweepscope
