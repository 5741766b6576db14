#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/recording/packed/decompress.hpp"

namespace sweepscope {

/// Packs a chunk so that the readers of ROS 1 bags and of MCAP files unpack it: bz2 as rosbag writes it; LZ4
/// in frames of independent blocks with a checksum, which ROS 1's own reader asks for; Zstandard, level 3.
/// Equal bytes give equal bytes.
std::string compressed(Compression compression, std::string_view bytes);

/// The checksum of MCAP's chunks and attachments (CRC-32 as zip has it).
std::uint32_t crc32_of(std::span<const std::byte> bytes);

}  // namespace sweepscope
