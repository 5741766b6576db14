#pragma once

#include "core/geometry/map_cloud.hpp"

namespace sweepscope {

/// One point per cube of `voxel_m`, the one nearest to its middle, with its own time and sweep (PCL's uniform
/// sampling; a mean would belong to no sweep). Points keep their order.
MapCloud::Ptr thinned(const MapCloud::ConstPtr& cloud, double voxel_m);

/// Removes the points whose mean distance to their 8 nearest neighbours is more than 3 standard deviations
/// above the whole map's (PCL's statistical outlier removal): mixed pixels in mid-air, mostly.
MapCloud::Ptr without_outliers(const MapCloud::ConstPtr& cloud);

}  // namespace sweepscope
