// MapPoint is our own type, so PCL's filters are instantiated here.
#define PCL_NO_PRECOMPILE
#include "core/map/clean_map.hpp"

#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/uniform_sampling.h>

#include <algorithm>

namespace sweepscope {

MapCloud::Ptr thinned(const MapCloud::ConstPtr& cloud, double voxel_m) {
  MapCloud::Ptr kept(new MapCloud);
  if (cloud->empty()) return kept;
  pcl::UniformSampling<MapPoint> filter;
  filter.setInputCloud(cloud);
  filter.setRadiusSearch(voxel_m);
  filter.filter(*kept);
  std::stable_sort(kept->begin(), kept->end(),
                   [](const MapPoint& a, const MapPoint& b) { return a.time_s < b.time_s; });
  return kept;
}

MapCloud::Ptr without_outliers(const MapCloud::ConstPtr& cloud) {
  MapCloud::Ptr kept(new MapCloud);
  if (cloud->empty()) return kept;
  pcl::StatisticalOutlierRemoval<MapPoint> filter;
  filter.setInputCloud(cloud);
  filter.setMeanK(8);
  filter.setStddevMulThresh(3.0);
  filter.filter(*kept);
  return kept;
}

}  // namespace sweepscope
