#include "core/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

namespace sweepscope {

namespace {

namespace fs = std::filesystem;

Error cannot_be(std::string_view done, const fs::path& path, std::string_view reason) {
  return {ExitCode::kWrongUsage, fmt::format("{}: cannot be {}: {}", path.string(), done, reason)};
}

tl::unexpected<Error> failed_to(std::string_view done, const fs::path& path) {
  return tl::unexpected(cannot_be(done, path, std::strerror(errno)));
}

/// Where the bytes go in the end.
struct Target {
  fs::path path;          // with symbolic links followed, also to a file that does not exist yet
  bool in_place = false;  // it exists and cannot be replaced: a pipe or a character device
};

Result<Target> target_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (path.filename().empty() || fs::is_directory(status))
    return tl::unexpected(cannot_be("written", path, "it is a folder"));
  if (fs::is_block_file(status)) return tl::unexpected(cannot_be("written", path, "it is a block device"));
  if (fs::exists(status) && !fs::is_regular_file(status)) return Target{path, true};
  return behind_links(path).map([](fs::path&& target) { return Target{std::move(target), false}; });
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// A new name beside the target, short enough for every file system.
fs::path name_beside(const fs::path& target) {
  constexpr std::size_t kMaxStem_bytes = 200;
  std::uint32_t number = 0;
  if (getrandom(&number, sizeof number, 0) != sizeof number) number = static_cast<std::uint32_t>(getpid());
  const std::string stem = target.filename().string().substr(0, kMaxStem_bytes);
  return folder_of(target) / fmt::format("{}.{:08x}.part", stem, number);
}

/// Gives the new file the permissions and, where that is allowed, the owner of the file that it replaces.
void hand_on_permissions(const fs::path& replaced, int descriptor) {
  struct stat status {};
  if (stat(replaced.c_str(), &status) != 0) return;
  if (fchown(descriptor, status.st_uid, status.st_gid) != 0) errno = 0;
  if (fchmod(descriptor, status.st_mode & 0777) != 0) errno = 0;
}

/// A file that the caller may not write is not replaced, though its folder would allow it.
bool is_protected(const fs::path& target) {
  return access(target.c_str(), F_OK) == 0 && access(target.c_str(), W_OK) != 0;
}

struct Part {
  fs::path path;
  int descriptor = -1;  // -1: see errno
};

Part create_part(const fs::path& target) {
  constexpr int kTries = 100;
  if (is_protected(target)) return {};
  for (int i = 0; i < kTries; ++i) {
    const fs::path part = name_beside(target);
    const int descriptor = create_unfinished(part);
    if (descriptor >= 0) flock(descriptor, LOCK_EX | LOCK_NB);  // see remove_abandoned_parts
    if (descriptor >= 0) hand_on_permissions(target, descriptor);
    if (descriptor >= 0 || errno != EEXIST) return {part, descriptor};
  }
  return {};
}

void discard(const fs::path& part) {
  if (part.empty()) return;
  std::remove(part.c_str());
  forget_unfinished(part);
}

}  // namespace

AtomicFile::AtomicFile(fs::path path, fs::path target, fs::path part, std::FILE* file)
    : path_(std::move(path)), target_(std::move(target)), part_path_(std::move(part)), file_(file) {}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  discard(part_path_);
}

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
  const auto target = target_of(path);
  if (!target) return tl::unexpected(target.error());
  const Part part = target->in_place ? Part{{}, open(target->path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY)}
                                     : create_part(target->path);
  if (part.descriptor < 0) return failed_to("created", path);
  return AtomicFile(path, target->path, part.path, fdopen(part.descriptor, "wb"));
}

Result<AtomicFile> AtomicFile::create_seekable(const fs::path& path) {
  auto file = create(path);
  if (!file || !file->part_path_.empty()) return file;
  auto whole = TemporaryFile::create();
  if (!whole) return tl::unexpected(whole.error());
  file->pipe_ = std::exchange(file->file_, {std::fopen(whole->path().c_str(), "wb"), {}});
  file->whole_.emplace(std::move(*whole));
  if (!file->file_) return failed_to("created", file->part_path());
  return file;
}

Result<void> AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    return failed_to("written", path_);
  return {};
}

Error AtomicFile::error(std::string_view reason) const {
  return cannot_be("written", path_, reason);
}

Result<void> AtomicFile::flush() {
  if (std::fflush(file_.get()) != 0) return failed_to("written", path_);
  // Some file systems say only now that they are full.
  if (!part_path_.empty() && fsync(fileno(file_.get())) != 0) return failed_to("written", path_);
  return {};
}

/// Into the pipe or the device.
Result<void> AtomicFile::copy_whole() {
  if (auto flushed = flush(); !flushed) return flushed;
  file_ = std::move(pipe_);
  std::string block(std::size_t{1} << 20, '\0');
  std::ifstream input(whole_->path(), std::ios::binary);
  while (input.read(block.data(), static_cast<std::streamsize>(block.size())), input.gcount() > 0)
    if (auto written = write({block.data(), static_cast<std::size_t>(input.gcount())}); !written)
      return written;
  return {};
}

Result<void> AtomicFile::commit() {
  if (whole_)
    if (auto copied = copy_whole(); !copied) return copied;
  if (auto flushed = flush(); !flushed) return flushed;
  if (std::fclose(file_.release()) != 0 ||
      (!part_path_.empty() && std::rename(part_path_.c_str(), target_.c_str()) != 0)) {
    auto error = failed_to("written", path_);
    discard(part_path_);
    return error;
  }
  if (!part_path_.empty()) forget_unfinished(part_path_);
  return {};
}

Result<fs::path> behind_links(const fs::path& path) {
  constexpr int kMaxLinks = 40;  // as the kernel
  std::error_code ignored;
  fs::path target = path;
  for (int links = 0; fs::is_symlink(target, ignored); ++links) {
    if (links == kMaxLinks) return tl::unexpected(cannot_be("created", path, std::strerror(ELOOP)));
    target = target.parent_path() / fs::read_symlink(target, ignored);
  }
  return target;
}

Result<void> check_writable(const fs::path& path) {
  const auto target = target_of(path);
  if (!target) return tl::unexpected(target.error());
  if (target->in_place) return {};
  if (access(folder_of(target->path).c_str(), W_OK | X_OK) != 0 || is_protected(target->path))
    return failed_to("created", path);
  return {};
}

Result<void> write_file(const fs::path& path, std::string_view bytes) {
  return AtomicFile::create(path).and_then([&](AtomicFile&& file) -> Result<void> {
    if (auto written = file.write(bytes); !written) return written;
    return file.commit();
  });
}

Result<std::string> read_file(const fs::path& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) return unreadable(fmt::format("{}: no such file", path.string()));
  if (!fs::is_regular_file(status)) {
    return unreadable(fmt::format("{}: not a regular file", path.string()));
  }
  const auto size = fs::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) {
    return unreadable(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  }
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace sweepscope
