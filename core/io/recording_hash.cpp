#include "core/io/recording_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/io/content_hash.hpp"

namespace sweepscope {

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

}  // namespace sweepscope
