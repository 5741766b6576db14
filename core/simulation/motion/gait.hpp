#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {

/// How a person carrying the rig sways: with every stride to the sides, with every step up and down.
struct Sway {
  double roll_rad, pitch_rad, yaw_rad, left_m, up_m;
};

/// The rotation by angle_rad about the axis-th coordinate axis.
Eigen::Quaterniond about(int axis, double angle_rad);

/// The rotation about z that turns x to `forward`, of unit length.
Eigen::Quaterniond heading(const Eigen::Vector2d& forward);

/// The orientation of a rig that sways while its carrier faces `heading`.
Eigen::Quaterniond swayed(const Eigen::Quaterniond& heading, const Sway& sway);

/// Amplitudes at walking speed, and those of a slow drift that also a person who stands has.
struct GaitSize {
  double roll_deg = 0.7, pitch_deg = 0.4, yaw_deg = 0.8, left_m = 0.012, up_m = 0.010;
  double drift_deg = 0.15;
};

class Gait {
 public:
  /// `seed` sets the phases.
  explicit Gait(std::uint64_t seed, const GaitSize& size = {});

  Sway at(double t_s, double speed_mps) const;

 private:
  GaitSize size_;
  std::array<SinCos, 7> phases_;
  double drift_phase_ = 0;
};

}  // namespace sweepscope::simulation
