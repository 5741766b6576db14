#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "render/comparison/comparison.hpp"

namespace sweepscope {

/// How thick a map's surfaces are: median_mm, p90_mm, and flat_part of all cubes that hold points.
nlohmann::ordered_json thickness_json(const MapThickness& thickness);

/// A comparison as a JSON object (schema "sweepscope.compare/1"), with a line end. "map_consistency": of the
/// path that all maps share (see consistency_json). "maps": each map's label, offset_ms and thickness (null
/// where there is none). "places": where they differ most, best first: x_m and y_m in the map frame, height_m
/// of a close-up, the "cells" of 5 cm that each map fills there, the numbers of the "sharpest" and the
/// "most_blurred" map, counted from 0, and the ratio of their cells.
std::string comparison_json(std::span<const ComparedMap> maps, std::span<const DifferingPlace> places);

}  // namespace sweepscope
