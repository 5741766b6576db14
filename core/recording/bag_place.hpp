#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace sweepscope {

/// Where a record of a bag is, in words that a person can follow with a hex editor.
struct BagPlace {
  std::uint64_t file_byte = 0;              // of the chunk, or of the record where it is in none
  std::optional<std::uint64_t> chunk_byte;  // within the unpacked chunk
  std::string text() const;                 // "byte 4117" or "byte 82 of the chunk at byte 4117"
};

}  // namespace sweepscope
