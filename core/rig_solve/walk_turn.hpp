#pragma once

// The mathematics: docs/rig.md.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/loam/path/sweep_pose.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// By how much a walk shows the laser to be turned in the frame that turns with the motor: R' = exp(turn) R
/// as in RigUnknowns, R the recording's mount.
struct WalkTurn {
  Eigen::Vector2d turn_rad = Eigen::Vector2d::Zero();    // rotation vector, along the axes of `across_axis`
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of the two angles, in rad^2
};

/// From a walk that was solved with a free path. The path takes up a wrong turn as a sway in step with the
/// motor, Rot(axis, phi) turn, with a kink at each reversal, where the motor changes its direction at once
/// and a body does not. Absent where it was tracked for fewer than 10 s in which it moves.
std::optional<WalkTurn> turn_of_walk(const Recording& recording, const std::vector<SweepPose>& sweeps,
                                     double offset_s);

/// The uncertainty of the turn from the steps between successive solutions of a walk (standard deviation,
/// rad). If the track is good, steps shrink by about half or more, down to some hundredths of a degree. If it
/// is bad, each solution has another turn: the last step, and the largest amount by which a step exceeded
/// half of the one before it, add in quadrature.
double unconverged_rad(std::span<const double> steps_rad);

}  // namespace sweepscope
