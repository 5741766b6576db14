#pragma once

// The mathematics: docs/algorithms.md, section 16.

#include <Eigen/Core>

#include "core/geometry/kinematics.hpp"

namespace sweepscope {

/// What lies between the angle that the encoder shows and the angle of the laser.
struct Gear {
  /// Between the flanks of the gear: the laser stays where it is while the motor turns back by this much.
  double play_rad = 0;
  /// The encoder's first harmonic, of a disc off its centre: at an angle phi that is shown the shaft is at
  /// phi - encoder_rad[0] sin(phi) - encoder_rad[1] cos(phi).
  Eigen::Vector2d encoder_rad = Eigen::Vector2d::Zero();

  bool perfect() const { return play_rad == 0 && encoder_rad.isZero(0); }
};

/// The laser's angles, from those that the encoder shows.
MotorTrack laser_angles(const MotorTrack& shown, const Gear& gear);

}  // namespace sweepscope
