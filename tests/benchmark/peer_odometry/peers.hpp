#pragma once

#include <vector>

#include "peer_clouds.hpp"
#include "sweepscope/core/geometry/pose.hpp"

namespace sweepscope {

/// KISS-ICP, a pose for each cloud: at its last beam or, without deskewing, at its middle.
std::vector<StampedPose> kiss_icp_poses(const std::vector<PeerCloud>& clouds, double voxel_m, bool deskew);

/// loam_velodyne's odometry and mapping, both on every cloud; a pose for each at its end. `scale` is the part
/// that its voxels are of the ones it is shipped with.
std::vector<StampedPose> loam_velodyne_poses(const std::vector<PeerCloud>& clouds, double scale);

}  // namespace sweepscope
