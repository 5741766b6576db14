#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <cstdint>

namespace sweepscope {

/// A point of a map: position in the map frame (m), intensity (0 if the laser has none), time of the beam
/// (laser clock, seconds since Recording::epoch_ns) and the number of its sweep. Consecutive sweeps turn in
/// opposite directions.
struct EIGEN_ALIGN16 MapPoint {
  PCL_ADD_POINT4D;      // x, y, z in m
  float intensity;      // 0 if the laser has none
  std::uint32_t sweep;  // the number of its sweep
  double time_s;        // laser clock, seconds since Recording::epoch_ns
};

/// Points in order of time.
using MapCloud = pcl::PointCloud<MapPoint>;

}  // namespace sweepscope

POINT_CLOUD_REGISTER_POINT_STRUCT(sweepscope::MapPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)(
                                      std::uint32_t, sweep, sweep)(double, time_s, time_s))
