#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/map/consistency/map_consistency.hpp"

namespace sweepscope {

/// "map_consistency" of a map's JSON: worst_m, at_s (the two times) and place_m, null where no surface was
/// seen twice; limit_m, warned and warnings; apart, the farthest five with their own apart_m, at_s and
/// place_m; unfit_s and undetermined_s, as pairs of times; drifting, each with at_s, place_m, direction and
/// drift_m. Seconds count from the first scan, places in the
/// map frame. A null pointer gives null.
nlohmann::ordered_json consistency_json(const MapConsistency* consistency);

}  // namespace sweepscope
