#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace sweepscope {

/// Unpacks LZF data, as in compressed PCD files. Nothing where the data are broken or do not unpack to
/// exactly `unpacked_bytes`.
std::optional<std::string> lzf_unpack(std::string_view packed, std::size_t unpacked_bytes);

}  // namespace sweepscope
