#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sweepscope {

/// How a chunk of a recording is compressed.
enum class Compression { kNone, kBz2, kLz4, kZstd };

/// As ROS 1 bags name it: "none", "bz2" or "lz4"; empty for any other name.
std::optional<Compression> compression_named(std::string_view name);

/// The unpacked bytes of a compressed block, and its damage (empty if intact). The bytes before the damage
/// are included in either case.
struct Decompressed {
  std::span<const std::byte> bytes;
  std::string problem;
  bool too_long = false;  // it would have unpacked to more than `max_bytes`
};

/// Decompresses `block` (bz2, or the frame formats of LZ4 and Zstandard) into `buffer`, which grows with the
/// actual output and never beyond `max_bytes`. The result points into `buffer`, or into `block` if that is
/// not compressed.
Decompressed decompress(Compression compression, std::span<const std::byte> block, std::size_t max_bytes,
                        std::vector<std::byte>& buffer);

/// The position of a record of a bag, in words that a person can follow with a hex editor.
struct BagPlace {
  std::uint64_t file_byte = 0;              // of the chunk, or of the record if it is in no chunk
  std::optional<std::uint64_t> chunk_byte;  // within the unpacked chunk
  std::string text() const;                 // "byte 4117" or "byte 82 of the chunk at byte 4117"
};

}  // namespace sweepscope
