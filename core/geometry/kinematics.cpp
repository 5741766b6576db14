#include "core/geometry/kinematics.hpp"

namespace sweepscope {

double MotorTrack::angle_at(double t_s) const {
  const auto upper = std::upper_bound(time_s.begin(), time_s.end(), t_s);
  const std::size_t i = std::clamp<std::ptrdiff_t>(upper - time_s.begin(), 1, std::ssize(time_s) - 1);
  const double u = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  return angle_rad[i - 1] + u * (angle_rad[i] - angle_rad[i - 1]);
}

bool MotorTrack::covers(double from_s, double to_s, double max_gap_s) const {
  if (time_s.size() < 2 || from_s < time_s.front() || to_s > time_s.back()) return false;
  auto sample = std::upper_bound(time_s.begin(), time_s.end(), from_s);
  for (; sample != time_s.end(); ++sample) {
    if (*sample - *(sample - 1) > max_gap_s) return false;
    if (*sample >= to_s) break;
  }
  return true;
}

}  // namespace sweepscope
