#pragma once

#include <array>

#include "core/offset/estimate.hpp"

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

}  // namespace sweepscope
