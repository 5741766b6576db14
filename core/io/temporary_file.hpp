#pragma once

#include <filesystem>
#include <utility>

#include "core/error.hpp"

namespace sweepscope {

/// Creates a file that did not exist (O_EXCL) with the permissions of the umask, opens it for writing and
/// remembers it until it is forgotten. Returns its descriptor, or -1 with errno.
int create_unfinished(const std::filesystem::path& path);

/// Remembers a file or a folder that the caller created, until it is forgotten.
void remember_unfinished(const std::filesystem::path& path);
void forget_unfinished(const std::filesystem::path& path);

/// Removes the remembered files. Call it last, in a program that ends without returning to their writers:
/// every other function here waits forever from then on, so that no new file is created.
void remove_unfinished_files();

/// An empty file of our own in the folder for temporary files (TMPDIR), which goes with this object. It is
/// locked (flock) as long as the object lives, so that a file whose program was killed can be told.
class TemporaryFile {
 public:
  /// Fails with ExitCode::kWrongUsage and the system's reason.
  static Result<TemporaryFile> create();

  TemporaryFile(TemporaryFile&& other) noexcept
      : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {
    other.path_.clear();
  }
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  ~TemporaryFile();

  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFile(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}

  std::filesystem::path path_;
  int lock_;  // the file, open
};

/// Removes the temporary files that programs which were killed left in the folder for temporary files: those
/// of this user that nobody has locked. What cannot be removed stays.
void remove_abandoned_temporary_files();

}  // namespace sweepscope
