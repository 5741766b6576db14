#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

namespace sweepscope {

/// The whole number from `least` to `greatest` that a JSON value is. Absent for all else: the library turns
/// other numbers, whatever their size, into the type that is asked for.
template <typename Value>
std::optional<std::int64_t> whole_number(const Value& value, std::int64_t least, std::int64_t greatest) {
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() && value.template get<std::uint64_t>() > std::uint64_t{INT64_MAX})
    return std::nullopt;
  const auto number = value.template get<std::int64_t>();
  if (number < least || number > greatest) return std::nullopt;
  return number;
}

}  // namespace sweepscope
