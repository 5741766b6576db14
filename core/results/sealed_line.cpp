#include "core/results/sealed_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

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

// The file may be put in order, and thereby renamed away, between opening and locking.
int open_locked(const std::filesystem::path& path) {
  constexpr int kTries = 10;
  for (int i = 0; i < kTries; ++i) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    // Where a file system knows no locks there is none.
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor);
      errno = EWOULDBLOCK;
      return -1;
    }
    struct stat opened {
    }, named{};
    if (fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
        opened.st_dev == named.st_dev)
      return descriptor;
    close(descriptor);
  }
  errno = EWOULDBLOCK;
  return -1;
}

bool write_whole(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace sweepscope
