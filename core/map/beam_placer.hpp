#pragma once

#include <cmath>

#include "core/geometry/kinematics.hpp"
#include "core/geometry/map_cloud.hpp"
#include "core/loam/path/sweep_pose.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Places beams with the motor angle of their own instant, t_motor = t_laser + offset, along poses. The
/// recording must outlive it.
class BeamPlacer {
 public:
  BeamPlacer(const Recording& recording, double offset_s)
      : recording_(recording),
        kinematics_(recording.rig.mount),
        motor_(recording.motor),
        offset_s_(offset_s) {}

  /// Appends every beam of a scan with a range, in the frame that the pose leads to. Scans mostly ascend.
  void place(const LaserScan& scan, const SweepPose& pose, MapCloud& cloud) {
    const SweepMotion motion = pose.motion();
    const auto ranges_m = recording_.ranges(scan);
    for (std::uint32_t beam = 0; beam < scan.beams; ++beam) {
      if (!std::isfinite(ranges_m[beam])) continue;
      const double time_s = scan.beam_s(beam);
      const double u = (time_s - pose.begin_s) / (pose.end_s - pose.begin_s);
      const Eigen::Vector3d p_in_motor_m =
          kinematics_.point_in_motor(ranges_m[beam], recording_.direction(scan, beam));
      const Eigen::Vector3d p_m =
          motion(kinematics_.base_from_motor(p_in_motor_m, motor_.angle_at(time_s + offset_s_)), u);
      MapPoint point{};
      point.getVector3fMap() = p_m.cast<float>();
      point.data[3] = 1.0f;
      point.intensity =
          recording_.intensities.empty() ? 0.0f : recording_.intensities[scan.first_range + beam];
      point.sweep = static_cast<std::uint32_t>(pose.sweep);
      point.time_s = time_s;
      cloud.points.push_back(point);
    }
  }

 private:
  const Recording& recording_;
  Kinematics kinematics_;
  MotorReader motor_;
  double offset_s_;
};

}  // namespace sweepscope
