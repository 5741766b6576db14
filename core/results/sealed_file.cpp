#include "core/results/sealed_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/io/atomic_file.hpp"

namespace sweepscope {
namespace {

// Opens a file, or creates it, and locks it; -1 with errno where that fails (EWOULDBLOCK: another run has
// it). The file may be put in order, and thereby renamed away, between opening and locking.
int open_locked(const std::filesystem::path& path) {
  constexpr int kTries = 10;
  for (int i = 0; i < kTries; ++i) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
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

// Appends all bytes; false with errno where that fails.
bool write_whole(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

SealedFile::SealedFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)), descriptor_(descriptor) {}

SealedFile::SealedFile(SealedFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

SealedFile::~SealedFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<SealedFile> SealedFile::open(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    return failure(ExitCode::kWrongUsage, fmt::format("{}: is not a regular file", path.string()));
  const int descriptor = open_locked(path);
  if (descriptor >= 0) return SealedFile(path, descriptor);
  const std::string why = errno == EWOULDBLOCK ? "another run is writing it" : std::strerror(errno);
  return failure(ExitCode::kWrongUsage, fmt::format("{}: cannot be opened: {}", path.string(), why));
}

Result<std::string> SealedFile::text() const {
  return read_file(path_);
}

bool SealedFile::is_begun(std::string_view text, std::string_view header) {
  return text.size() < header.size() && header.starts_with(text);
}

tl::unexpected<Error> SealedFile::cannot_write() const {
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

Result<void> SealedFile::begin(std::string_view header) {
  if (auto cut_off = cut(0); !cut_off) return cut_off;
  return append(header);
}

Result<void> SealedFile::cut(std::size_t whole_bytes) {
  if (ftruncate(descriptor_, static_cast<off_t>(whole_bytes)) != 0) return cannot_write();
  return {};
}

Result<void> SealedFile::append(std::string_view line) {
  const off_t end = lseek(descriptor_, 0, SEEK_END);
  if (write_whole(descriptor_, line)) return {};
  auto error = cannot_write();
  if (ftruncate(descriptor_, end) != 0) return error;  // a broken last line is cut off by the next run
  return error;
}

}  // namespace sweepscope
