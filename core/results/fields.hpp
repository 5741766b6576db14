#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/offset/estimate.hpp"

/// Common parts of the files of estimates and of candidates.
namespace sweepscope {

/// The names of a candidate's values in files, in the order in which they are written.
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

/// An offset as it is written, in milliseconds: to 1e-9 ms, so that 0.0239 s is 23.9 and
/// not 23.900000000000002.
inline double written_ms(double seconds) {
  return std::round(seconds * 1e12) / 1e9;
}

/// The readings that were tried of a recording's messages.
nlohmann::ordered_json readings_json(const std::vector<BeamReading>& readings);
std::vector<BeamReading> readings_of(const nlohmann::ordered_json& json);

/// Three numbers. Throws the library's exception where there are none.
inline Eigen::Vector3d vector_of(const nlohmann::ordered_json& object, const char* key) {
  const auto values = object.at(key).get<std::array<double, 3>>();
  return {values[0], values[1], values[2]};
}

/// A JSON value as a whole number from `least` to `greatest`; absent for anything else. The library would
/// convert other numbers of any size to the requested type.
template <typename Value>
std::optional<std::int64_t> whole_number(const Value& value, std::int64_t min, std::int64_t max) {
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() && value.template get<std::uint64_t>() > std::uint64_t{INT64_MAX})
    return std::nullopt;
  const auto number = value.template get<std::int64_t>();
  if (number < min || number > max) return std::nullopt;
  return number;
}

}  // namespace sweepscope
