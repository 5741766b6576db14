#include "core/io/atomic_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/io/temporary_file.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_be_created(const fs::path& path, const char* why) {
  return failure(ExitCode::kWrongUsage, fmt::format("{}: cannot be created: {}", path.string(), why));
}

/// Without a slash at the end.
fs::path without_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

Result<void> AtomicFolder::check(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path, error) && (!fs::is_directory(path, error) || !fs::is_empty(path, error)))
    return cannot_be_created(path, "it exists; name a new folder");
  const fs::path parent = without_slash(path).parent_path();
  if (access(parent.empty() ? "." : parent.c_str(), W_OK | X_OK) != 0)
    return cannot_be_created(path, std::strerror(errno));
  return {};
}

Result<AtomicFolder> AtomicFolder::create(const fs::path& path) {
  if (const auto checked = check(path); !checked) return tl::unexpected(checked.error());
  std::string pattern = unique_pattern(without_slash(path).string() + ".part-");
  if (mkdtemp(pattern.data()) == nullptr) return cannot_be_created(path, std::strerror(errno));
  remember_unfinished(pattern);
  std::error_code ignored;
  const auto all = fs::perms::owner_all | fs::perms::group_all | fs::perms::others_all;
  const auto umasked = [&] {
    const mode_t mask = umask(0);
    umask(mask);
    return static_cast<fs::perms>(mask);
  }();
  fs::permissions(pattern, all & ~umasked, ignored);  // mkdtemp gives them to the owner alone
  const int lock = open(pattern.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock >= 0) flock(lock, LOCK_EX | LOCK_NB);
  return AtomicFolder(without_slash(path), pattern, lock);
}

AtomicFolder::AtomicFolder(AtomicFolder&& other) noexcept
    : path_(std::move(other.path_)),
      part_path_(std::exchange(other.part_path_, {})),
      lock_(std::exchange(other.lock_, -1)) {}

AtomicFolder::~AtomicFolder() {
  if (lock_ >= 0) close(lock_);
  if (part_path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(part_path_, ignored);
  forget_unfinished(part_path_);
}

Result<void> AtomicFolder::commit() {
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0)
    return cannot_be_created(path_, std::strerror(errno));
  forget_unfinished(part_path_);
  part_path_.clear();
  return {};
}

}  // namespace sweepscope
