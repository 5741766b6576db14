#include "core/recording/packed/unpacking_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

std::uint64_t size_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  return error ? 0 : bytes;
}

}  // namespace

UnpackingLimit::UnpackingLimit(const fs::path& file)
    : UnpackingLimit(file.string(), size_of(file) + size_of(file.string() + "-wal")) {}

std::uint64_t UnpackingLimit::limit_bytes() const {
  const std::uint64_t per_packed = std::min(packed_bytes_, kMaxUnpacked_bytes) * kMaxUnpackedPerPacked;
  return std::min(kMaxUnpacked_bytes, std::max(kAlwaysUnpacked_bytes, per_packed));
}

std::uint64_t UnpackingLimit::max_bytes(std::uint64_t part_bytes) const {
  const std::uint64_t left = limit_bytes() - std::min(limit_bytes(), unpacked_bytes_);
  return std::min(part_bytes, left + 1);
}

std::optional<Error> UnpackingLimit::take(std::uint64_t unpacked_bytes) {
  unpacked_bytes_ += unpacked_bytes;
  if (unpacked_bytes_ <= limit_bytes()) return std::nullopt;
  return Error{ExitCode::kUnreadableInput,
               fmt::format("{}: its {} bytes unpack to more than {} bytes, the limit for a file of this "
                           "size; unpack it first if you trust it",
                           name_, packed_bytes_, limit_bytes())};
}

}  // namespace sweepscope
