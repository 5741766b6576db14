#pragma once

// The mathematics: docs/rig.md.

#include <Eigen/Core>

#include "core/geometry/kinematics.hpp"

namespace sweepscope {

/// The gear between the encoder and the laser.
struct Gear {
  /// Play between the flanks: after a reversal the laser rests until the motor has turned by this much.
  double play_rad = 0;
  /// The encoder's first harmonic, from an eccentric disc: where it shows phi, the shaft is at
  /// phi - encoder_rad[0] sin(phi) - encoder_rad[1] cos(phi).
  Eigen::Vector2d encoder_rad = Eigen::Vector2d::Zero();

  /// Neither play nor an eccentric disc.
  bool perfect() const { return play_rad == 0 && encoder_rad.isZero(0); }
};

/// The angles of the laser from those of the encoder.
MotorTrack laser_angles(const MotorTrack& shown, const Gear& gear);

}  // namespace sweepscope
