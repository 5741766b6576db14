#include "core/recording/bag_place.hpp"

#include <fmt/format.h>

namespace sweepscope {

std::string BagPlace::text() const {
  return chunk_byte ? fmt::format("byte {} of the chunk at byte {}", *chunk_byte, file_byte)
                    : fmt::format("byte {}", file_byte);
}

}  // namespace sweepscope
