#include "render/comparison/compared_map.hpp"

#include "render/comparison/scanner_pose.hpp"

namespace sweepscope {

ComparedMap compared_map(const Recording& recording, const OffsetMap& map, const FeatureSet* features) {
  ComparedMap compared;
  compared.offset_s = map.offset_s;
  compared.cloud = map.cloud;
  compared.path = map.trajectory;
  compared.scanner = scanner_pose(recording, map.trajectory, map.offset_s);
  if (features != nullptr) compared.feature_kinds = feature_kinds(*features, *map.cloud);
  return compared;
}

void measure_thickness(ComparedMap& map, const Job& job) {
  if (map.thickness || map.size() == 0) return;
  auto measured = std::make_shared<SurfaceThickness>(surface_thickness(*map.cloud, {}, job));
  if (!job.cancelled()) map.thickness = std::move(measured);
}

}  // namespace sweepscope
