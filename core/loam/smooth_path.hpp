#pragma once

#include <vector>

#include "core/loam/least_squares.hpp"
#include "core/loam/mapping.hpp"

namespace sweepscope {

/// A rig's path without jumps: poses map_from_base at equal steps of the laser's clock, interpolated between,
/// and going on at both ends.
class SmoothPath {
 public:
  /// Along tracked sweeps, at least one: where one's end and the next one's begin lie apart, both meet half
  /// way. Knots, at which the path can be moved, lie `knot_s` apart; the first at the first sweep's begin.
  SmoothPath(const std::vector<SweepPose>& sweeps, double knot_s);

  Pose at(double time_s) const;

  std::size_t knots() const { return knots_; }
  Pose knot(std::size_t i) const { return poses_[i * kPosesPerKnot]; }
  /// The knot before an instant, and how far on to the next one it lies, 0 to 1.
  struct Place {
    std::size_t knot;
    double u;
  };
  Place place(double time_s) const;

  /// Moves every pose by a step, each about its own place (see `stepped`); between knots linearly.
  void move(const std::vector<Vector6d>& knot_steps);

  /// The path as a sweep's pose: begin, end and the bend between them.
  SweepPose as_sweep(SweepPose sweep) const;

 private:
  static constexpr std::size_t kPosesPerKnot = 8;
  double begin_s_, pose_s_;
  std::size_t knots_;
  std::vector<Pose> poses_;  // from the first knot to the last
};

}  // namespace sweepscope
