#include "core/simulation/motion/gait.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope::simulation {
namespace {

constexpr double kCadence_hz = 1.8;  // steps; a stride, left and right, is two
constexpr std::uint64_t kSwayPurpose = 1;

}  // namespace

Eigen::Quaterniond about(int axis, double angle_rad) {
  const SinCos half = sin_cos(angle_rad / 2);
  Eigen::Quaterniond q(half.cos, 0, 0, 0);
  q.vec()[axis] = half.sin;
  return q;
}

Eigen::Quaterniond heading(const Eigen::Vector2d& forward) {
  const double cos_half = std::sqrt(std::max(0.0, (1 + forward.x()) / 2));
  const double sin_half = std::sqrt(std::max(0.0, (1 - forward.x()) / 2));
  return {cos_half, 0, 0, forward.y() < 0 ? -sin_half : sin_half};
}

Eigen::Quaterniond swayed(const Eigen::Quaterniond& heading, const Sway& sway) {
  return heading * about(2, sway.yaw_rad) * about(1, sway.pitch_rad) * about(0, sway.roll_rad);
}

Gait::Gait(std::uint64_t seed, const GaitSize& size) : size_(size) {
  Random random(seed, kSwayPurpose, 0);
  for (SinCos& phase : phases_) phase = sin_cos(2 * kPi * random.uniform());
  drift_phase_ = 2 * kPi * random.uniform();
}

Sway Gait::at(double t_s, double speed_mps) const {
  const SinCos drift = sin_cos(2 * kPi * 0.11 * t_s + drift_phase_);
  const SinCos stride = sin_cos(kPi * kCadence_hz * t_s + 0.3 * drift.sin);
  const SinCos step = {2 * stride.sin * stride.cos, stride.cos * stride.cos - stride.sin * stride.sin};
  const auto shifted = [&](const SinCos& wave, int phase) {
    const SinCos& by = phases_[static_cast<std::size_t>(phase)];
    return wave.sin * by.cos + wave.cos * by.sin;
  };
  const double stir = smooth_step(speed_mps / 0.6), drift_rad = radians(size_.drift_deg);
  return {radians(size_.roll_deg) * stir * shifted(stride, 0) + drift_rad * shifted(drift, 5),
          radians(size_.pitch_deg) * stir * shifted(step, 1) + drift_rad * shifted(drift, 6),
          radians(size_.yaw_deg) * stir * shifted(stride, 2), size_.left_m * stir * shifted(stride, 3),
          size_.up_m * stir * shifted(step, 4)};
}

}  // namespace sweepscope::simulation
