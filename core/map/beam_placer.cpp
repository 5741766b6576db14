#include "core/map/beam_placer.hpp"

#include "core/map/beams.hpp"

namespace sweepscope {

BeamPlacer::BeamPlacer(const Recording& recording, const ScanPoses& poses,
                       const std::optional<Pose>& frame_from_map)
    : recording_(recording),
      poses_(poses),
      frame_from_map_(frame_from_map),
      kinematics_(recording.rig.mount),
      motor_(recording.motor) {}

bool BeamPlacer::start(std::size_t scan) {
  const std::uint32_t number = poses_.pose_of(scan);
  if (number == ScanPoses::kNone) return false;
  scan_ = &recording_.scans[scan];
  if (scan_->angle_min_rad != angle_min_rad_ || scan_->angle_increment_rad != angle_increment_rad_ ||
      scan_->beams > directions_.size()) {
    angle_min_rad_ = scan_->angle_min_rad;
    angle_increment_rad_ = scan_->angle_increment_rad;
    directions_.assign(scan_->beams, std::nullopt);
  }
  if (number == pose_) return true;
  pose_ = number;
  const SweepPose& pose = poses_.poses()[number];
  begin_s_ = pose.begin_s;
  end_s_ = pose.end_s;
  std::vector<Pose> knots = pose.knots;
  if (frame_from_map_)
    for (Pose& knot : knots) knot = *frame_from_map_ * knot;
  motion_.emplace(knots);
  return true;
}

Eigen::Vector3d BeamPlacer::direction(std::uint32_t beam) {
  if (!recording_.directions.empty()) return recording_.direction(*scan_, beam);
  std::optional<Eigen::Vector3d>& known = directions_[beam];
  if (!known) known = recording_.direction(*scan_, beam);
  return *known;
}

Eigen::Vector3d BeamPlacer::p_m(std::uint32_t beam) {
  const double time_s = scan_->beam_s(beam);
  const Eigen::Vector3d p_in_motor_m =
      kinematics_.point_in_motor(recording_.ranges(*scan_)[beam], direction(beam));
  const double angle_rad = motor_.angle_at(time_s + poses_.offset_s());
  return (*motion_)(kinematics_.base_from_motor(p_in_motor_m, angle_rad),
                    (time_s - begin_s_) / (end_s_ - begin_s_));
}

MapPoint BeamPlacer::point(std::uint32_t beam) {
  MapPoint point{};
  point.getVector3fMap() = p_m(beam).cast<float>();
  point.data[3] = 1.0f;
  point.intensity = beam_intensity(recording_, *scan_, beam);
  point.sweep = static_cast<std::uint32_t>(poses_.poses()[pose_].sweep);
  point.time_s = scan_->beam_s(beam);
  return point;
}

}  // namespace sweepscope
