#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace sweepscope {

/// Creates a new file (O_EXCL) with the permissions of the umask, opens it for writing and registers it for
/// removal until it is forgotten. Returns its descriptor, or -1 with errno.
int create_unfinished(const std::filesystem::path& path);

/// A template for mkstemp and mkdtemp, which put characters of their own for its last six.
inline constexpr std::size_t kUnique_chars = 6;
inline std::string unique_pattern(const std::filesystem::path& prefix) {
  return prefix.string() + std::string(kUnique_chars, 'X');
}

/// Registers a file or a folder that the caller created, until it is forgotten.
void remember_unfinished(const std::filesystem::path& path);
void forget_unfinished(const std::filesystem::path& path);

/// Removes the registered files. Call it last, in a program that ends without returning to their writers:
/// from then on every other function here blocks forever, so that no new file is created.
void remove_unfinished_files();

/// An empty file in the folder for temporary files (TMPDIR), removed with this object. It is locked (flock)
/// as long as the object lives, so that the file of a killed program can be recognised.
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

/// Removes the temporary files that killed programs left in the folder for temporary files: those of this
/// user that are not locked. Files that cannot be removed stay.
void remove_abandoned_temporary_files();

}  // namespace sweepscope
