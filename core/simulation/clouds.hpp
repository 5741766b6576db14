#pragma once

#include "core/recording/raw_recording.hpp"
#include "core/simulation/sensor.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope::simulation {

/// The messages of a 3D scanner: each turn as sensor_msgs/PointCloud2, as velodyne_pointcloud writes it (x,
/// y, z in m, intensity, ring, and time in s since the stamp, which is that of the first beam), and the scan
/// lines that they are read as. Points without a usable return are left out. `cast` has the ranges of all
/// rays, in the order of Sensor::cast_turn.
RawLaser clouds_of(const Simulation& cast, const Sensor& sensor);

}  // namespace sweepscope::simulation
