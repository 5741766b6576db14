#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/recording/ros2/mcap_records.hpp"

namespace sweepscope {

/// A record of an MCAP file that holds no message: an attachment, metadata, or a private one.
struct McapExtra {
  McapOp op = McapOp::kHeader;
  std::uint64_t at = 0, bytes = 0;  // of its content
};

struct McapExtras {
  std::string profile;
  std::vector<McapExtra> records;  // of the data section, in the order of the file
};

/// Goes from record to record and reads no more than their headers. Of a damaged file those before the
/// damage.
Result<McapExtras> find_mcap_extras(const std::filesystem::path& path);

/// The content of one, in blocks, to `write`; at most `max_bytes` of it.
Result<void> read_mcap_extra(const std::filesystem::path& path, const McapExtra& extra,
                             std::uint64_t max_bytes,
                             const std::function<Result<void>(std::string_view)>& write);

}  // namespace sweepscope
