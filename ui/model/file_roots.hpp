#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace sweepscope::ui {

/// The folders that files are read and written below, where others than the owner of the files name them.
/// Without folders every path is allowed. Symbolic links count as what they point to, also where that does
/// not exist yet.
class FileRoots {
 public:
  FileRoots() = default;
  /// Errors, of a folder that does not exist, are ExitCode::kWrongUsage and name it.
  static Result<FileRoots> of(std::span<const std::filesystem::path> folders);

  /// This file or folder may be read as well, wherever it is: the owner named it.
  void allow_reading(const std::filesystem::path& path);

  bool limited() const { return !folders_.empty(); }
  /// As they are without symbolic links.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

  bool can_read(const std::filesystem::path& path) const;
  bool can_write(const std::filesystem::path& path) const;
  /// The same, as an error (ExitCode::kWrongUsage) that names the path as it was given and the folders. It is
  /// the same error whether or not the path exists.
  Result<void> check_read(const std::filesystem::path& path) const;
  Result<void> check_write(const std::filesystem::path& path) const;

 private:
  Error outside(const std::filesystem::path& path) const;

  std::vector<std::filesystem::path> folders_, readable_;
};

}  // namespace sweepscope::ui
