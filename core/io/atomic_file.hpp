#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

/// A file that appears whole or not at all: written beside its place (`PATH.part`), renamed into it by
/// `commit`. Without a commit, or after a failed one, nothing is left behind and an older file at `path` is
/// untouched.
///
/// An output that cannot be written (no such folder, read-only, disk full) is ExitCode::kWrongUsage, with a
/// sentence that names the file and the system's reason.
class AtomicFile {
 public:
  static Result<AtomicFile> create(const std::filesystem::path& path);

  AtomicFile(AtomicFile&& other) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  Result<void> write(std::string_view bytes);
  /// Call once, last.
  Result<void> commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  explicit AtomicFile(const std::filesystem::path& path);

  std::filesystem::path path_, part_path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Whether `path` can be created as things stand, by AtomicFile's errors: for work that takes its time, and
/// would end with nothing. Creates nothing.
Result<void> check_writable(const std::filesystem::path& path);

/// The whole of a small file at once.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

/// The whole of a regular file. The sentence on failure names the file and the system's reason.
Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace sweepscope
