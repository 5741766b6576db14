#include <loam_velodyne/BasicLaserMapping.h>
#include <loam_velodyne/BasicLaserOdometry.h>
#include <loam_velodyne/BasicScanRegistration.h>

#include "peers.hpp"

namespace sweepscope {
namespace {

// Without an IMU only the part of it counts that has passed at a point, so it need not be the sweep's.
constexpr float kPeriod_s = 0.1f;

using Line = pcl::PointCloud<pcl::PointXYZI>;

// Its axes are left, up, forward; ours are forward, left, up.
const Eigen::Matrix3d kTheirsFromBase{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};

/// The scans as its rings. A point's intensity is its ring plus its time.
std::vector<Line> rings_of(const PeerCloud& cloud) {
  std::vector<Line> rings;
  for (const auto& line : cloud.lines) {
    const float ring = float(rings.size());
    for (Line& points = rings.emplace_back(); const PeerPoint& from : line) {
      pcl::PointXYZI point;
      point.getVector3fMap() = (kTheirsFromBase * from.p_in_base_m).cast<float>();
      point.intensity = ring + kPeriod_s * float(from.u);
      points.push_back(point);
    }
  }
  return rings;
}

StampedPose base_pose(const loam::Twist& pose, double time_s) {
  const Eigen::Vector3d position_m(pose.pos.x(), pose.pos.y(), pose.pos.z());
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(pose.rot_y.rad(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(pose.rot_x.rad(), Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(pose.rot_z.rad(), Eigen::Vector3d::UnitZ());
  return {time_s, kTheirsFromBase.transpose() * position_m,
          Eigen::Quaterniond(kTheirsFromBase.transpose() * rotation * kTheirsFromBase)};
}

}  // namespace

// Where a sweep has more sharp corners than the last one had corners, its odometry reads beyond the end of a
// vector; so on 6 of the 28 walks. It is measured as it is: repeated runs gave equal numbers.
std::vector<StampedPose> loam_velodyne_poses(const std::vector<PeerCloud>& clouds, double scale) {
  loam::RegistrationParams parameters(kPeriod_s);
  parameters.lessFlatFilterSize *= float(scale);
  loam::BasicScanRegistration registration;
  registration.configure(parameters);
  loam::BasicLaserOdometry odometry(kPeriod_s);
  loam::BasicLaserMapping mapping(kPeriod_s);
  const auto scale_voxels = [scale](auto& filter) {
    const Eigen::Vector3f size_m = filter.getLeafSize() * float(scale);
    filter.setLeafSize(size_m.x(), size_m.y(), size_m.z());
  };
  scale_voxels(mapping.downSizeFilterCorner());
  scale_voxels(mapping.downSizeFilterSurf());

  std::vector<StampedPose> poses;
  for (const PeerCloud& cloud : clouds) {
    const loam::Time end{
        std::chrono::duration_cast<loam::Time::duration>(std::chrono::duration<double>(cloud.end_s))};
    registration.processScanlines(end, rings_of(cloud));
    *odometry.cornerPointsSharp() = registration.cornerPointsSharp();
    *odometry.cornerPointsLessSharp() = registration.cornerPointsLessSharp();
    *odometry.surfPointsFlat() = registration.surfacePointsFlat();
    *odometry.surfPointsLessFlat() = registration.surfacePointsLessFlat();
    odometry.updateIMU(registration.imuTransform());
    odometry.process();
    // The cloud of all points is only for others to look at.
    mapping.laserCloudCornerLast() = *odometry.lastCornerCloud();
    mapping.laserCloudSurfLast() = *odometry.lastSurfaceCloud();
    mapping.updateOdometry(odometry.transformSum());
    mapping.process(end);
    poses.push_back(base_pose(mapping.transformAftMapped(), cloud.end_s));
  }
  return poses;
}

}  // namespace sweepscope
