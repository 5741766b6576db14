#include "render/comparison/compared_map.hpp"

#include <fmt/format.h>

#include "core/map/consistency/map_consistency.hpp"
#include "render/comparison/scanner_pose.hpp"

namespace sweepscope {

ComparedMap compared_map(const Recording& recording, const OffsetMap& map, const FeatureSet* features) {
  ComparedMap compared;
  compared.offset_s = map.offset_s;
  compared.cloud = map.cloud;
  compared.path = map.trajectory;
  compared.consistency = map.consistency;
  compared.scanner = scanner_pose(recording, map.trajectory, map.offset_s);
  if (features != nullptr) compared.feature_kinds = feature_kinds(*features, *map.cloud);
  return compared;
}

std::string in_words(const ComparedMap& map) {
  std::string words = map.thickness && map.thickness->map ? in_words(*map.thickness->map)
                                                          : std::string("no surface has a thickness");
  if (!map.consistency || map.consistency->agrees_with_itself()) return words;
  words += "; the map does not agree with itself";
  const auto worst = map.consistency->worst();
  if (worst && worst->apart_m > map.consistency->limit_m)
    words += fmt::format(": surfaces seen twice lie {:.1f} m apart", worst->apart_m);
  return words;
}

void measure_thickness(ComparedMap& map, const Job& job) {
  if (map.thickness || map.size() == 0) return;
  auto measured = std::make_shared<SurfaceThickness>(surface_thickness(*map.cloud, {}, job));
  if (!job.cancelled()) map.thickness = std::move(measured);
}

}  // namespace sweepscope
