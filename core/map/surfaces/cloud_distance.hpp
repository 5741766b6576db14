#pragma once

#include <vector>

#include "core/geometry/map_cloud.hpp"

namespace sweepscope {

struct DistanceOptions {
  double cap_m = 0.2;  // greater distances count as this
};

/// For each point of `from` the distance (m) to the nearest point of `to`, at most cap_m. Noise alone puts
/// the nearest points of two maps of one place apart by about as much as the points' spacing.
std::vector<float> distances_to_m(const MapCloud& from, const MapCloud& to,
                                  const DistanceOptions& options = {});

}  // namespace sweepscope
