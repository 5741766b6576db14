#include "core/recording/ros2/mcap_records.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace sweepscope {
namespace {

constexpr std::array<std::pair<Compression, std::string_view>, 3> kCompressions{
    {{Compression::kNone, ""}, {Compression::kLz4, "lz4"}, {Compression::kZstd, "zstd"}}};

}  // namespace

std::optional<Compression> mcap_compression(std::string_view name) {
  const auto* known = std::ranges::find(kCompressions, name, &decltype(kCompressions)::value_type::second);
  return known != kCompressions.end() ? std::optional(known->first) : std::nullopt;
}

std::string_view mcap_name(Compression compression) {
  const auto* known =
      std::ranges::find(kCompressions, compression, &decltype(kCompressions)::value_type::first);
  return known != kCompressions.end() ? known->second : "";
}

}  // namespace sweepscope
