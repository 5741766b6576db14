#include "render/comparison/scanner_pose.hpp"

#include <algorithm>

namespace sweepscope {

ScannerPose scanner_pose(const Recording& recording, std::span<const StampedPose> path, double offset_s,
                         double until_s) {
  if (!recording.scans.empty()) until_s = std::min(until_s, recording.scans.back().first_beam_s);
  StampedPose base;
  base.time_s = until_s;
  if (!path.empty()) {
    const auto after =
        std::upper_bound(path.begin(), path.end(), until_s,
                         [](double time_s, const StampedPose& pose) { return time_s < pose.time_s; });
    base = after == path.begin() ? path.front() : *std::prev(after);
  }
  const Kinematics kinematics(recording.rig.mount);
  MotorReader motor(recording.motor);
  const double angle_rad = motor.angle_at(base.time_s + offset_s);
  const auto place = [&](double range_m, double beam_rad) -> Eigen::Vector3d {
    const Eigen::Vector3d p_in_base =
        kinematics.base_from_motor(kinematics.point_in_motor(range_m, beam_rad), angle_rad);
    return base.orientation * p_in_base + base.position_m;
  };
  const Eigen::Vector3d origin_m = place(0, 0);
  return {origin_m, place(1, 0) - origin_m, place(1, M_PI / 2) - origin_m};
}

}  // namespace sweepscope
