#include "core/io/abandoned_parts.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <string_view>

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// NAME.xxxxxxxx.part of a file, NAME.part-xxxxxx of a folder.
bool is_part_of(std::string_view name, std::string_view part) {
  if (!part.starts_with(name)) return false;
  part.remove_prefix(name.size());
  const std::size_t dot = part.starts_with(".part-") ? 12 : 14;
  return part.size() == dot && part.front() == '.' && (dot == 12 || part.ends_with(".part"));
}

void remove_abandoned_part(const fs::path& path) {
  const int part = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (part < 0) return;
  struct stat status {};
  const bool own = fstat(part, &status) == 0 && status.st_uid == geteuid() &&
                   (S_ISDIR(status.st_mode) || S_ISREG(status.st_mode));
  std::error_code ignored;
  if (own && flock(part, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, ignored);
  close(part);
}

}  // namespace

void remove_abandoned_parts(const fs::path& output) {
  const fs::path named = output.has_filename() ? output : output.parent_path();
  const fs::path folder = named.has_parent_path() ? named.parent_path() : fs::path(".");
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_part_of(named.filename().string(), entry->path().filename().string()))
      remove_abandoned_part(entry->path());
}

}  // namespace sweepscope
