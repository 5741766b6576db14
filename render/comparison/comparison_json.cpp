#include "render/comparison/comparison_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/io/printable_text.hpp"
#include "core/results/consistency_json.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

Json map_json(const ComparedMap& map) {
  const Json offset_ms = map.offset_s ? Json(std::round(*map.offset_s * 1e12) / 1e9) : Json(nullptr);
  const bool measured = map.thickness && map.thickness->map;
  const Json thickness = measured ? thickness_json(*map.thickness->map) : Json(nullptr);
  return {{"label", map.label}, {"offset_ms", offset_ms}, {"thickness", thickness}};
}

Json place_json(const DifferingPlace& place) {
  const Region& region = place.region;
  return {{"x_m", std::round(region.centre_m.x() * 1e3) / 1e3},
          {"y_m", std::round(region.centre_m.y() * 1e3) / 1e3},
          {"height_m", std::round(region.height_m * 1e3) / 1e3},
          {"cells", place.cells},
          {"sharpest", place.sharpest()},
          {"most_blurred", place.most_blurred()},
          {"ratio", std::round(place.ratio() * 1e3) / 1e3}};
}

}  // namespace

Json thickness_json(const MapThickness& thickness) {
  return {{"median_mm", std::round(thickness.median_m * 1e4) / 10},
          {"p90_mm", std::round(thickness.p90_m * 1e4) / 10},
          {"flat_part", std::round(thickness.flat_part * 1e3) / 1e3}};
}

std::string comparison_json(std::span<const ComparedMap> maps, std::span<const DifferingPlace> places) {
  const MapConsistency* consistency = maps.empty() ? nullptr : maps.front().consistency.get();
  Json json{{"schema", "sweepscope.compare/1"},
            {"map_consistency", consistency_json(consistency)},
            {"maps", Json::array()},
            {"places", Json::array()}};
  for (const ComparedMap& map : maps) json["maps"].push_back(map_json(map));
  for (const DifferingPlace& place : places) json["places"].push_back(place_json(place));
  return json_text(std::move(json));
}

}  // namespace sweepscope
