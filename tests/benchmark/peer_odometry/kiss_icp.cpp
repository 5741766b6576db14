#include <kiss_icp/pipeline/KissICP.hpp>

#include "peers.hpp"

namespace sweepscope {

std::vector<StampedPose> kiss_icp_poses(const std::vector<PeerCloud>& clouds, double voxel_m, bool deskew) {
  kiss_icp::pipeline::KISSConfig config;
  config.voxel_size = voxel_m;
  config.max_range = 30;
  config.min_range = 0.3;
  config.deskew = deskew;
  config.max_num_threads = 1;  // the processor time that waiting threads take is not the method's
  kiss_icp::pipeline::KissICP odometry(config);
  std::vector<StampedPose> poses;
  for (const PeerCloud& cloud : clouds) {
    std::vector<Eigen::Vector3d> points_m;
    std::vector<double> times;
    for (const auto& line : cloud.lines) {
      for (const PeerPoint& point : line) {
        points_m.push_back(point.p_in_base_m);
        times.push_back(point.u);
      }
    }
    odometry.RegisterFrame(points_m, times);
    // Deskewing moves all points to the instant of the last one. Without it the pose is that of none: the
    // middle is its best guess.
    const double u = deskew ? times.back() : 0.5;
    poses.push_back({cloud.begin_s + u * (cloud.end_s - cloud.begin_s), odometry.pose().translation(),
                     odometry.pose().unit_quaternion()});
  }
  return poses;
}

}  // namespace sweepscope
