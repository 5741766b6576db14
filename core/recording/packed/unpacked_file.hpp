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

/// A packed file may hold no more than this, however small it is itself.
inline constexpr std::uint64_t kMaxUnpackedFile_bytes = std::uint64_t{64} << 30;

/// What a file packed by Zstandard holds: a file in the folder for temporary files (TMPDIR), which goes with
/// this object.
class UnpackedFile {
 public:
  /// Streamed, with a few MiB of memory. Refuses what cannot be read (ExitCode::kUnreadableInput) or
  /// written (kWrongUsage: a full disk), and what holds more than `max_bytes`.
  static Result<UnpackedFile> unpack(const std::filesystem::path& packed, const Job& job,
                                     std::uint64_t max_bytes = kMaxUnpackedFile_bytes);
  /// The same for a file that is one layer of several.
  static Result<UnpackedFile> unpack(const std::filesystem::path& packed, UnpackingLimit& limit,
                                     const Job& job, std::uint64_t max_bytes = kMaxUnpackedFile_bytes);

  const std::filesystem::path& path() const { return file_.path(); }
  /// What was wrong with the packed file; empty where it was whole. What came before the damage is there.
  const std::string& problem() const { return problem_; }

 private:
  explicit UnpackedFile(TemporaryFile file) : file_(std::move(file)) {}

  TemporaryFile file_;
  std::string problem_;
};

}  // namespace sweepscope
