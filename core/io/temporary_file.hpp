#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace sweepscope {

/// An empty file of our own in the folder for temporary files (TMPDIR), which goes with this object.
class TemporaryFile {
 public:
  /// Fails with ExitCode::kWrongUsage and the system's reason.
  static Result<TemporaryFile> create();

  TemporaryFile(TemporaryFile&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  ~TemporaryFile();

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFile(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
};

}  // namespace sweepscope
