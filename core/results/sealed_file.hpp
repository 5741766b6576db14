#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

/// A file of sealed lines (see sealed_line.hpp) that a command appends to while it works: a run that is
/// killed loses only what it was writing. It is locked against a second run until it is destroyed; where a
/// file system knows no locks there is none.
class SealedFile {
 public:
  /// Opens the file, or creates an empty one. ExitCode::kWrongUsage if it is not a regular file, another run
  /// is writing it, or it cannot be opened.
  static Result<SealedFile> open(const std::filesystem::path& path);
  SealedFile(SealedFile&& other) noexcept;
  SealedFile& operator=(SealedFile&& other) = delete;
  ~SealedFile();

  const std::filesystem::path& path() const { return path_; }
  Result<std::string> text() const;
  /// Whether a text is nothing, or a header that was not written to its end.
  static bool is_begun(std::string_view text, std::string_view header);

  /// Makes the header line the whole of the file. This and the next two: ExitCode::kWrongUsage if it cannot
  /// be written.
  Result<void> begin(std::string_view header);
  /// Cuts off what is behind the whole lines, so that a last line that was not written to its end does not
  /// run into the next one.
  Result<void> cut(std::size_t whole_bytes);
  /// Appends a line, or nothing.
  Result<void> append(std::string_view line);

 private:
  SealedFile(std::filesystem::path path, int descriptor);
  tl::unexpected<Error> cannot_write() const;

  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace sweepscope
