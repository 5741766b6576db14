#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/io/temporary_file.hpp"

namespace sweepscope {

/// An output file that appears whole or not at all. A regular file is written under a unique new name in the
/// same folder (`NAME.xxxxxxxx.part`) and renamed into place by `commit`: of several programs that write the
/// same file at once, the last that finishes wins, with its own content. Symbolic links are followed, and the
/// permissions of a replaced file are kept. Without a commit, or after a failed one, no new file remains and
/// an older file is unchanged. A named pipe or a character device is written in place.
///
/// Errors are ExitCode::kWrongUsage with a sentence that names the file and the system's reason, such as a
/// missing folder, a missing permission or a full disk. Folders and block devices are refused.
class AtomicFile {
 public:
  static Result<AtomicFile> create(const std::filesystem::path& path);
  /// The same for a writer that goes back to what it wrote: a pipe or a device gets the whole file at
  /// `commit`.
  static Result<AtomicFile> create_seekable(const std::filesystem::path& path);

  AtomicFile(AtomicFile&& other) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  Result<void> write(std::string_view bytes);
  /// The error that a library reports for this file, which it writes by name.
  Error error(std::string_view reason) const;
  /// The regular file that `commit` renames or copies, for a library that opens files by name; empty for
  /// files written in place.
  const std::filesystem::path& part_path() const { return whole_ ? whole_->path() : part_path_; }

  /// Flushes the data to the disk, so that `commit` only has to rename. Call it on all files of a set before
  /// committing the first.
  Result<void> flush();
  /// Call once, last.
  Result<void> commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  AtomicFile(std::filesystem::path path, std::filesystem::path target, std::filesystem::path part,
             std::FILE* file);
  Result<void> copy_whole();

  std::filesystem::path path_, target_, part_path_;
  std::optional<TemporaryFile> whole_;  // what a pipe or a device gets
  std::unique_ptr<std::FILE, Close> file_, pipe_;
};

/// The target of a file's symbolic links, also if the target does not exist yet; an error if they do not
/// resolve.
Result<std::filesystem::path> behind_links(const std::filesystem::path& path);

/// Checks that `path` can be created, with AtomicFile's errors, before long work whose result goes there.
/// Creates nothing.
Result<void> check_writable(const std::filesystem::path& path);

/// Writes a small file at once.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

/// Reads a regular file. The error names the file and the system's reason.
Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace sweepscope
