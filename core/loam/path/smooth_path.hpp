#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <array>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/loam/path/sweep_pose.hpp"

namespace sweepscope {

/// A rig's path without jumps or kinks: a uniform cubic B-spline, cumulative in the rotation (Kim, Kim and
/// Shin 1995), of poses map_from_base over the laser's clock. Beyond its ends it continues linearly.
class SmoothPath {
 public:
  /// Near tracked sweeps, at least one: where one's end and the next one's begin lie apart, both meet half
  /// way. Knots, by which the path can be moved, lie `knot_s` apart.
  SmoothPath(const std::vector<SweepPose>& sweeps, double knot_s);

  Pose at(double time_s) const;

  std::size_t knots() const { return knots_.size(); }
  const Pose& knot(std::size_t i) const { return knots_[i]; }
  /// The four knots that an instant depends on, and how a step of each acts there: the weights add up to 1.
  struct Place {
    std::size_t first_knot;
    std::array<double, 4> weights;
  };
  Place place(double time_s) const;

  /// Moves every knot by a step, about its own place (see `stepped`).
  void move(const std::vector<Vector6d>& knot_steps);

  /// The path as a sweep's pose, linear between many knots.
  SweepPose as_sweep(SweepPose sweep) const;

 private:
  static constexpr std::size_t kPosesPerKnot = 8;  // straight pieces err by 1/64 of the sag between knots
  void sample();

  double begin_s_, knot_s_;
  std::size_t segments_;     // segment j lies between knots j + 1 and j + 2
  std::vector<Pose> knots_;  // the first one lies knot_s before the path's begin
  std::vector<Pose> poses_;  // along the segments, at equal steps: linear between, to well below a millimetre
};

}  // namespace sweepscope
