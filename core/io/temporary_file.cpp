#include "core/io/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string_view>

namespace sweepscope {
namespace {

struct Unfinished {
  std::mutex mutex;
  std::multiset<std::filesystem::path> paths;
};

// Never destroyed: another thread may end the program while it is in use.
Unfinished& unfinished() {
  static Unfinished* const all = new Unfinished;
  return *all;
}

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = ".sweepscope-temporary-";  // what a person would hardly name a file

/// Waits for a program that looks whether the file is abandoned. False where that one removed it.
bool lock_own(int file) {
  while (flock(file, LOCK_EX) != 0 && errno == EINTR) {
  }
  struct stat status {};
  return fstat(file, &status) == 0 && status.st_nlink > 0;
}

/// As TemporaryFile makes them: a regular file of this user with one name, readable by this user only.
bool is_ours(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
         status.st_nlink == 1 && (status.st_mode & 0777) == 0600;
}

void remove_if_abandoned(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  // The lock first: what was removed meanwhile has no name any more.
  if (flock(file, LOCK_EX | LOCK_NB) == 0 && is_ours(file)) std::remove(path.c_str());
  close(file);
}

}  // namespace

int create_unfinished(const std::filesystem::path& path) {
  const std::lock_guard lock(unfinished().mutex);
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) unfinished().paths.insert(path);
  return descriptor;
}

void remember_unfinished(const std::filesystem::path& path) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.insert(path);
}

void forget_unfinished(const std::filesystem::path& path) {
  const std::lock_guard lock(unfinished().mutex);
  const auto found = unfinished().paths.find(path);
  if (found != unfinished().paths.end()) unfinished().paths.erase(found);
}

void remove_unfinished_files() {
  unfinished().mutex.lock();
  std::error_code ignored;
  for (const auto& path : unfinished().paths) fs::remove_all(path, ignored);  // a folder with its files
}

Result<TemporaryFile> TemporaryFile::create() {
  const auto refused = [](const std::string& folder, const std::string& why) {
    return failure(
        ExitCode::kWrongUsage,
        fmt::format("{}: no temporary file can be made: {}; set TMPDIR to a folder with room", folder, why));
  };
  remove_abandoned_temporary_files();
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) return refused("TMPDIR", error.message());
  while (true) {
    std::string path = unique_pattern(folder / kPrefix);
    const int file = mkostemp(path.data(), O_CLOEXEC);
    if (file < 0) return refused(folder.string(), std::strerror(errno));
    if (lock_own(file)) {
      remember_unfinished(path);
      return TemporaryFile(path, file);
    }
    close(file);
  }
}

TemporaryFile::~TemporaryFile() {
  if (path_.empty()) return;
  std::remove(path_.c_str());
  close(lock_);
  forget_unfinished(path_);
}

void remove_abandoned_temporary_files() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) return;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() == kPrefix.size() + kUnique_chars && name.starts_with(kPrefix))
      remove_if_abandoned(entry->path());
  }
}

}  // namespace sweepscope
