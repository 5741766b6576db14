#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"

namespace sweepscope {

/// A file of a recording unpacks to no more than this, over all layers of compression ...
inline constexpr std::uint64_t kMaxUnpacked_bytes = std::uint64_t{1} << 40;
/// ... and, beyond this, to no more than so many times its own size. Recordings of scans stay below 20.
inline constexpr std::uint64_t kAlwaysUnpacked_bytes = std::uint64_t{256} << 20;
inline constexpr std::uint64_t kMaxUnpackedPerPacked = 250;

/// Counts the unpacked bytes of a file's packed parts, also nested ones: a few kilobytes can be made to
/// unpack for hours.
class UnpackingLimit {
 public:
  /// With the size of the file on disk, and of its journal if there is one.
  explicit UnpackingLimit(const std::filesystem::path& file);
  UnpackingLimit(std::string name, std::uint64_t packed_bytes)
      : name_(std::move(name)), packed_bytes_(packed_bytes) {}

  /// How much a part of at most `part_bytes` may unpack to before take() refuses it.
  std::uint64_t max_bytes(std::uint64_t part_bytes) const;
  /// The error (ExitCode::kUnreadableInput) if the file unpacked to too much.
  std::optional<Error> take(std::uint64_t unpacked_bytes);

 private:
  std::uint64_t limit_bytes() const;

  std::string name_;
  std::uint64_t packed_bytes_ = 0, unpacked_bytes_ = 0;
};

}  // namespace sweepscope
