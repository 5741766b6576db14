#pragma once

// The mathematics: docs/algorithms.md, section 12.

#include <memory>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/loam/path/sweep_pose.hpp"

namespace sweepscope {

/// The base frame's motion measured by another sensor: a motion capture system, a camera, wheels or an
/// inertial sensor. Poses world_from_base over a clock of their own; adding `time_shift_s` to their stamps
/// gives the laser's clock. Between poses the motion is cubic (Hermite) in the rotation and the translation.
class GivenMotion {
 public:
  /// A prior: the rig's motion deviates from it, the more smoothly the better the prior. The truth: the rig
  /// moved exactly like this.
  enum class Role { kPrior, kTruth };
  enum class Parts { kRotation, kRotationAndTranslation };

  /// At least two poses, ascending in time. With Parts::kRotation their positions are not used.
  GivenMotion(std::vector<StampedPose> poses, Parts parts, Role role);

  /// From angular velocities in the base frame (rad/s), ascending in time, at least two: their integral, a
  /// prior of the rotation.
  static GivenMotion from_rates(const std::vector<double>& times_s,
                                const std::vector<Eigen::Vector3d>& rates_rad_s);

  /// The same motion with another time shift.
  GivenMotion with_time_shift(double time_shift_s) const;
  /// The same motion as a prior instead of the truth.
  GivenMotion as_prior() const;
  double time_shift_s() const { return time_shift_s_; }
  Role role() const { return role_; }
  bool is_truth() const { return role_ == Role::kTruth; }
  bool has_translation() const { return parts_ == Parts::kRotationAndTranslation; }

  /// The first and the last instant, on the laser's clock.
  double begin_s() const { return data_->poses.front().time_s + time_shift_s_; }
  double end_s() const { return data_->poses.back().time_s + time_shift_s_; }
  /// Whether the poses cover this time of the laser's clock without a gap. A gap is longer than 0.25 s and
  /// than three times the median spacing.
  bool covers(double from_s, double to_s) const;

  /// world_from_base at an instant of the laser's clock; beyond the poses the nearest one. The translation is
  /// 0 without Parts::kRotationAndTranslation.
  Pose at(double time_s) const;
  /// The motion between two instants: pose(to) = pose(from) * move, as far as it is known.
  Pose move(double from_s, double to_s) const { return at(from_s).inverse() * at(to_s); }

 private:
  struct Data {
    std::vector<StampedPose> poses;
    std::vector<Eigen::Vector3d> rates_rad_s, velocities_m_s;  // of the base frame, in it; and in the world
    std::vector<std::size_t> covered_until;                    // for each pose, the last one before a gap
  };

  std::shared_ptr<const Data> data_;
  Parts parts_;
  Role role_;
  double time_shift_s_ = 0;
};

/// How a sweep's motion deviates from a given one: the velocities of its parts (see `twists_per_s`) beyond
/// those of the given motion. `time_sign` is -1 for a sweep whose time runs backwards (see `reversed`).
/// Without a given motion, or where it does not cover the sweep, the velocities themselves.
std::vector<Vector6d> deviation_twists_per_s(const SweepPose& pose, std::size_t parts,
                                             const GivenMotion* given, double time_sign);

/// The sweeps that are not lost, cut where one is, where the next one is of another stretch, and where
/// `given` begins or ceases to cover them.
std::vector<std::vector<SweepPose>> tracked_runs(const std::vector<SweepPose>& sweeps,
                                                 const GivenMotion* given = nullptr);

/// A sweep's pose along a given motion from `start` on, which is the pose at `start_s`, with knots about
/// `knot_s` apart.
SweepPose along(const GivenMotion& given, SweepPose sweep, const Pose& start, double start_s, double knot_s);

}  // namespace sweepscope
