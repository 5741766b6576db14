#pragma once

#include "core/numbers.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope::test {

/// A rig that rolls about x, whose mount and encoder were found and whose play was not.
inline SolvedRig solved_rig_by_hand() {
  SolvedRig solved;
  solved.mount = {true, true, ""};
  solved.play = {true, false, "The motor turns at one speed only."};
  solved.encoder = {true, true, ""};
  solved.rig.mount.laser_in_motor_rpy_deg = {0, 3.0021, -1.5};
  solved.rig.mount.laser_in_motor_xyz_m = {0, 0.0125, 0};
  solved.rig.gear.encoder_amplitude_deg = 0.3;
  solved.rig.gear.encoder_phase_deg = 40;
  solved.given.gear.play_deg = solved.rig.gear.play_deg = 0.2;
  solved.priors = priors_of({.mount = true, .play = true, .encoder = true});
  RigVector sigma = RigVector::Zero();
  sigma.segment<2>(kTurnU).setConstant(0.004 * kRadPerDeg);
  sigma.segment<2>(kShiftU).setConstant(0.00021);
  sigma[kPlay] = 0.5 * kRadPerDeg;
  sigma.tail<2>().setConstant(0.01 * kRadPerDeg);
  solved.covariance = sigma.cwiseAbs2().asDiagonal();
  return solved;
}

}  // namespace sweepscope::test
