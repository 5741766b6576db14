#include "render/comparison/compared_map.hpp"

namespace sweepscope {

void measure_thickness(ComparedMap& map, const Job& job) {
  if (map.thickness || map.size() == 0) return;
  auto measured = std::make_shared<SurfaceThickness>(surface_thickness(*map.cloud, {}, job));
  if (!job.cancelled()) map.thickness = std::move(measured);
}

}  // namespace sweepscope
