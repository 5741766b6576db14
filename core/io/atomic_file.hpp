#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

/// An output file that appears whole or not at all. A regular file is written under a unique new name in the
/// same folder (`NAME.xxxxxxxx.part`) and renamed into place by `commit`: of several programs that write the
/// same file at once, the last that finishes wins, with its own content. Symbolic links are followed, and a
/// replaced file hands on its permissions. Without a commit, or after one that failed, nothing is left behind
/// and an older file is untouched. A named pipe or a character device is written in place.
///
/// Errors are ExitCode::kWrongUsage and a sentence that names the file and the system's reason: no such
/// folder, no permission, a full disk; also for a folder and for a block device, which are never written to.
class AtomicFile {
 public:
  static Result<AtomicFile> create(const std::filesystem::path& path);

  AtomicFile(AtomicFile&& other) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  Result<void> write(std::string_view bytes);
  /// What a library says about this file that it writes by name.
  Error error(std::string_view reason) const;
  /// The regular file that `commit` renames, for a library that opens files by name; empty for what is
  /// written in place.
  const std::filesystem::path& part_path() const { return part_path_; }

  /// Brings what was written to the disk, so that `commit` only has to rename. Call it on all files of a set
  /// before committing the first.
  Result<void> flush();
  /// Call once, last.
  Result<void> commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  AtomicFile(std::filesystem::path path, std::filesystem::path target, std::filesystem::path part,
             std::FILE* file);

  std::filesystem::path path_, target_, part_path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Where the symbolic links of a file lead, also where they lead to a file that does not exist yet; an error
/// where they lead nowhere.
Result<std::filesystem::path> behind_links(const std::filesystem::path& path);

/// Whether `path` can be created as things stand, by AtomicFile's errors: for work that takes its time, and
/// would end with nothing. Creates nothing.
Result<void> check_writable(const std::filesystem::path& path);

/// The whole of a small file at once.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

/// The whole of a regular file. The sentence on failure names the file and the system's reason.
Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace sweepscope
