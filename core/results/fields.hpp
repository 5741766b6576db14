#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/offset/estimate.hpp"

/// What the files of estimates and of candidates have in common.
namespace sweepscope {

/// The values of a candidate as files name them, in the order in which they are written.
struct CurveColumn {
  const char* key;
  std::optional<double> CurvePoint::*value;
};
inline constexpr std::array<CurveColumn, 7> kCurveColumns{
    {{"d", &CurvePoint::d},
     {"translation_m", &CurvePoint::translation_m},
     {"rotation_rad", &CurvePoint::rotation_rad},
     {"signed_rotation_rad", &CurvePoint::signed_rotation_rad},
     {"n", &CurvePoint::n},
     {"e_m", &CurvePoint::e_m},
     {"capped_cost_m", &CurvePoint::capped_cost_m}}};

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
