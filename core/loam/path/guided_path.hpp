#pragma once

// The mathematics: docs/algorithms.md, section 12.

#include <optional>
#include <vector>

#include "core/loam/path/given_motion.hpp"
#include "core/loam/path/smooth_path.hpp"

namespace sweepscope {

/// A rig's path map_from_base that follows a given motion, as an unknown of a least squares: the given
/// motion, aligned with tracked sweeps, and the deviation from it,
///     rotation(t) = deviation(t) given(t),   translation(t) = deviation(t) + given(t).
/// The deviation is a smooth path with knots to be moved; of a given motion that is the truth there is none.
/// The given motion's time shift is one more unknown. Without a given motion the path is the smooth path
/// alone.
class GuidedPath {
 public:
  /// Near tracked sweeps, at least one. `given` may be null; it is not used either where it does not cover
  /// the sweeps, and its rotation or translation not where the tracked sweeps deviate from it less smoothly
  /// than they move.
  GuidedPath(const std::vector<SweepPose>& sweeps, double knot_s, const GivenMotion* given);

  Pose at(double time_s) const;
  /// The path as a sweep's pose, linear between many knots.
  SweepPose as_sweep(SweepPose sweep) const;
  /// How sweeps on the path deviate from the given motion; the sweeps themselves without one.
  std::vector<SweepPose> deviations(std::vector<SweepPose> sweeps) const;

  /// The deviation's knots; 0 where the given motion is the truth.
  std::size_t knots() const { return deviation_ ? deviation_->knots() : 0; }
  const Pose& knot(std::size_t i) const { return deviation_->knot(i); }
  /// The unknowns, six each: the knots' steps and, with a given motion, a block whose first unknown is the
  /// time shift's step in seconds and whose others have no effect.
  std::size_t blocks() const { return knots() + (given_ ? 1 : 0); }
  /// The block of the time shift; none without a given motion.
  std::optional<std::size_t> shift_block() const { return given_ ? std::optional(knots()) : std::nullopt; }
  double time_shift_s() const { return given_ ? given_->time_shift_s() : 0; }

  /// What an instant depends on: four knots, each of which acts by its weight (all 0 without knots), and the
  /// time shift, by whose step the path there moves like `stepped` about its own place (rotation in rad/s,
  /// translation in m/s).
  struct Place {
    SmoothPath::Place knots;
    Vector6d per_shift_second;
  };
  Place place(double time_s) const;

  /// Moves every knot and the time shift by their blocks' steps.
  void move(const std::vector<Vector6d>& steps);

 private:
  void choose_parts(const std::vector<SweepPose>& sweeps);
  void sample();
  Pose given_at(double time_s) const;

  double begin_s_, end_s_;
  std::optional<SmoothPath> deviation_;
  std::optional<GivenMotion> given_;
  bool uses_rotation_ = true, uses_translation_ = true;
  Pose map_from_world_;
  std::vector<Pose> samples_;  // of the given motion in the map frame, at equal steps
};

}  // namespace sweepscope
