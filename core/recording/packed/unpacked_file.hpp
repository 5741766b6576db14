#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/io/temporary_file.hpp"
#include "core/job.hpp"
#include "core/recording/packed/unpacking_limit.hpp"

namespace sweepscope {

/// Whether the bytes begin a frame of Zstandard.
bool begins_zstd(std::span<const std::byte> bytes);

/// The limit of the unpacked size of a file, independent of its own size.
inline constexpr std::uint64_t kMaxUnpackedFile_bytes = std::uint64_t{64} << 30;

/// The content of a file packed by Zstandard, in a temporary file (TMPDIR) that is removed with this object.
class UnpackedFile {
 public:
  /// Streamed, with a few MiB of memory. Fails if it cannot be read (ExitCode::kUnreadableInput) or written
  /// (kWrongUsage, such as a full disk), or unpacks to more than `max_bytes`.
  static Result<UnpackedFile> unpack(const std::filesystem::path& packed, const Job& job,
                                     std::uint64_t max_bytes = kMaxUnpackedFile_bytes);
  /// The same for a file that is one layer of several.
  static Result<UnpackedFile> unpack(const std::filesystem::path& packed, UnpackingLimit& limit,
                                     const Job& job, std::uint64_t max_bytes = kMaxUnpackedFile_bytes);

  const std::filesystem::path& path() const { return file_.path(); }
  /// The damage of the packed file; empty if intact. The content before the damage is included.
  const std::string& problem() const { return problem_; }

 private:
  explicit UnpackedFile(TemporaryFile file) : file_(std::move(file)) {}

  TemporaryFile file_;
  std::string problem_;
};

}  // namespace sweepscope
