#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/map/feature_points.hpp"
#include "core/map/turnable_map.hpp"
#include "render/comparison/compared_map.hpp"

namespace sweepscope {

/// The thickness of the surface around each drawn beam of a live map, in the whole map at one offset.
struct BeamBlur {
  double offset_s = 0;
  std::vector<float> thickness_m;  // NaN where the surface has none
};

/// What colours the beams of a live map and cannot be computed from the beams that are drawn.
struct BeamColours {
  std::vector<FeatureKind> kinds;  // of each drawn beam
  std::vector<BeamBlur> blur;      // ascending in the offset
};

/// The blur as it was measured in a map of the same recording, whose points are identified by the time of
/// their beam and, of beams of the same time, by their position; `positions_m`: of the drawn beams at the
/// map's offset.
BeamBlur blur_of_beams(const TurnableMap& drawn, std::span<const std::array<float, 3>> positions_m,
                       const ComparedMap& map);

}  // namespace sweepscope
