#pragma once

#include <filesystem>

#include "core/error.hpp"

namespace sweepscope {

/// A folder of outputs that appears whole or not at all: its files are written in a folder with a unique new
/// name beside it, which `commit` renames. Without a commit nothing is left behind. An existing folder is
/// replaced only where it is empty.
class AtomicFolder {
 public:
  /// Whether it can be created as things stand; ExitCode::kWrongUsage.
  static Result<void> check(const std::filesystem::path& path);
  static Result<AtomicFolder> create(const std::filesystem::path& path);

  AtomicFolder(AtomicFolder&& other) noexcept;
  AtomicFolder& operator=(AtomicFolder&&) = delete;
  ~AtomicFolder();

  /// Where the files are written.
  const std::filesystem::path& part_path() const { return part_path_; }
  /// Call once, last.
  Result<void> commit();

 private:
  AtomicFolder(std::filesystem::path path, std::filesystem::path part, int lock)
      : path_(std::move(path)), part_path_(std::move(part)), lock_(lock) {}

  std::filesystem::path path_, part_path_;
  int lock_ = -1;  // the part, open and locked: see remove_abandoned_parts
};

}  // namespace sweepscope
