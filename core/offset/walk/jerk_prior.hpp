#pragma once

// The mathematics: docs/algorithms.md, sections 11 and 12.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/loam/path/guided_path.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/offset/walk/joint_walk.hpp"

namespace sweepscope {

/// Standard deviation of the jerk of a walk, or of its deviation from a given motion: of the rotation
/// (rad/s^3) and of the translation (m/s^3), from sweeps as they were tracked.
Eigen::Vector2d jerk_sigma(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps,
                           const JointWalkOptions& options);

/// The same of the acceleration (rad/s^2 and m/s^2).
Eigen::Vector2d acceleration_sigma(const std::vector<SweepPose>& sweeps, const MappingOptions& options);

/// Whether the motor slows down well before it turns back, as a sine does: a wrong offset then shows as a
/// roll that is as smooth as a body's sway, without a jump.
bool turns_back_smoothly(const OffsetProblem& problem);

/// The jerk of a path by its knots, times their spacing cubed: this times four knots in a row.
constexpr std::array<double, 4> kJerkStencil{-1, 3, -3, 1};
/// The jerk for every four knots in a row: rotation vectors and translations.
std::vector<Vector6d> third_differences(const GuidedPath& path);
/// The same of the acceleration, times the spacing squared.
constexpr std::array<double, 3> kAccelerationStencil{1, -2, 1};
std::vector<Vector6d> second_differences(const GuidedPath& path);

/// Learns that standard deviation from a path that was solved for, by the evidence for it (MacKay 1992): the
/// sum of the squared jerks over the number of them that the measurements determine. Tracked sweeps scatter
/// more than a rig deviates from a good prior. The number needs a trace of the inverse of the normal matrix,
/// which is estimated by a few random probes (Hutchinson 1990), the same ones each time.
class JerkEvidence {
 public:
  /// For paths of so many knots and equations of so many unknowns, the knots' six each first.
  JerkEvidence(std::size_t knots, Eigen::Index unknowns);

  /// One column a probe, half of them of the rotation, then half of the translation.
  const Eigen::MatrixXd& probes() const { return probes_; }
  /// `sigma` is what the path was solved with, `solved_probes` are the inverse matrix times the probes.
  Eigen::Vector2d sigma(const GuidedPath& path, double knot_s, const Eigen::Vector2d& sigma,
                        const Eigen::MatrixXd& solved_probes) const;

 private:
  Eigen::MatrixXd probes_;
};

}  // namespace sweepscope
