#include "core/recording/assemble/mount_from_frames.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr double kTurns_rad = 1.0 * kRadPerDeg;
constexpr std::size_t kMaxFrames = 64;  // between the laser and the motor

/// ROS 1 wrote frames with and without a leading slash.
std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

const RawFrame* find_child(const std::vector<RawFrame>& frames, const std::string& child) {
  for (const RawFrame& frame : frames)
    if (plain(frame.child) == plain(child)) return &frame;
  return nullptr;
}

double rounded(double value, double steps_a_unit) {
  return std::round(value * steps_a_unit) / steps_a_unit + 0.0;  // no -0
}

/// Roll, pitch and yaw of Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d rpy_deg(const Eigen::Matrix3d& r) {
  const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  return Eigen::Vector3d(std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))) / kRadPerDeg;
}

/// The motor's angle, continued in a straight line for `beyond_s` at both ends: a transform may be stamped a
/// little before the first sample.
std::optional<double> angle_near(const MotorTrack& motor, double t_s, double beyond_s) {
  const auto& times_s = motor.time_s;
  const double inside_s = std::clamp(t_s, times_s.front(), times_s.back());
  if (std::abs(t_s - inside_s) > beyond_s) return std::nullopt;
  if (t_s == inside_s) return motor.angle_at(t_s);
  const std::size_t i = t_s < inside_s ? 1 : times_s.size() - 1;
  const double slope = (motor.angle_rad[i] - motor.angle_rad[i - 1]) / (times_s[i] - times_s[i - 1]);
  return motor.angle_at(inside_s) + slope * (t_s - inside_s);
}

}  // namespace

std::optional<FrameMount> mount_from_frames(const std::vector<RawFrame>& frames,
                                            const std::string& laser_frame) {
  FrameMount mount;
  mount.chain.push_back(plain(laser_frame));
  const RawFrame* frame = find_child(frames, laser_frame);
  if (laser_frame.empty() || frame == nullptr) return std::nullopt;
  for (; frame != nullptr && mount.chain.size() < kMaxFrames; frame = find_child(frames, frame->parent)) {
    if (frame->turned_rad > kTurns_rad) {
      mount.parent = plain(frame->parent);
      mount.turning = *frame;
      const Eigen::AngleAxisd turn(frame->farthest.rotation * frame->first.rotation.conjugate());
      mount.axis = turn.axis();
      return mount;
    }
    mount.laser_in_motor_m = frame->first.rotation * mount.laser_in_motor_m + frame->first.translation_m;
    mount.motor_from_laser_rotation = frame->first.rotation * mount.motor_from_laser_rotation;
    mount.chain.push_back(plain(frame->parent));
  }
  return mount;
}

Rig::Mount rig_mount(const FrameMount& found, double first_rad, double sign) {
  Rig::Mount mount;
  Eigen::Quaterniond base_from_motor = Eigen::Quaterniond::Identity();
  if (found.turning) {
    mount.axis = sign * found.axis;
    base_from_motor = Eigen::AngleAxisd(-first_rad, mount.axis) * found.turning->first.rotation;
    for (double& part : mount.axis) part = rounded(part, 1e6);
    mount.axis.normalize();
  }
  mount.laser_in_motor_xyz_m = base_from_motor * found.laser_in_motor_m;
  mount.laser_in_motor_rpy_deg =
      rpy_deg((base_from_motor * found.motor_from_laser_rotation).toRotationMatrix());
  // To a hundredth of a millimetre and a ten thousandth of a degree: transforms are rounded products.
  for (double& part : mount.laser_in_motor_xyz_m) part = rounded(part, 1e5);
  for (double& part : mount.laser_in_motor_rpy_deg) part = rounded(part, 1e4);
  return mount;
}

std::optional<Rig::Mount> fitted_mount(const FrameMount& found, const Recording& recording) {
  if (!found.turning) return std::nullopt;
  const auto angle_rad = [&](const RawFrame::Pose& pose) -> std::optional<double> {
    const std::int64_t ns =
        recording.rig.motor.stamp == StampSource::kReceive ? pose.stamps.receive_ns : pose.stamps.header_ns;
    return angle_near(recording.motor, static_cast<double>(ns - recording.epoch_ns) * 1e-9,
                      2 * recording.report.motor_stamps.median_period_s);
  };
  const auto first_rad = angle_rad(found.turning->first), far_rad = angle_rad(found.turning->farthest);
  if (!first_rad || !far_rad || std::abs(*far_rad - *first_rad) < 0.25 * found.turning->turned_rad)
    return std::nullopt;
  return rig_mount(found, *first_rad, *far_rad > *first_rad ? 1 : -1);
}

}  // namespace sweepscope
