#pragma once

// The mathematics: docs/algorithms.md, section 2.

#include <optional>

#include "core/geometry/kinematics.hpp"
#include "core/geometry/map_cloud.hpp"
#include "core/map/scan_poses.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Places beams of a recording at an offset: p = X(t) R(a, phi(t + offset)) p_motor, with the motor angle of
/// the beam's own instant and the pose of its scan. All that places beams does it by this class. One for each
/// thread: scans mostly ascend. Recording and poses must outlive it.
class BeamPlacer {
 public:
  /// `frame_from_map`: into a frame other than the map's.
  BeamPlacer(const Recording& recording, const ScanPoses& poses,
             const std::optional<Pose>& frame_from_map = std::nullopt);

  /// Beams are those of this scan from now on. False: it is not placed.
  bool start(std::size_t scan);
  /// Where a beam lies that returned something.
  Eigen::Vector3d p_m(std::uint32_t beam);
  /// The same as a point of a map.
  MapPoint point(std::uint32_t beam);

 private:
  Eigen::Vector3d direction(std::uint32_t beam);

  const Recording& recording_;
  const ScanPoses& poses_;
  std::optional<Pose> frame_from_map_;
  Kinematics kinematics_;
  MotorReader motor_;
  const LaserScan* scan_ = nullptr;
  std::uint32_t pose_ = ScanPoses::kNone;  // that `motion_` is of
  std::optional<SweepMotion> motion_;
  double begin_s_ = 0, end_s_ = 1;
  // Of the beams of scans with these angles, as they are first asked for: sines cost a fifth of the time.
  double angle_min_rad_ = 0, angle_increment_rad_ = 0;
  std::vector<std::optional<Eigen::Vector3d>> directions_;
};

}  // namespace sweepscope
