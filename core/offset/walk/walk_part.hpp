#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/loam/patch_search.hpp"
#include "core/loam/path/guided_path.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/offset/walk/jerk_prior.hpp"
#include "core/offset/walk/joint_walk.hpp"
#include "core/offset/walk/walk_equations.hpp"

namespace sweepscope {

/// One part of a walk on its way to its own offset, see solve_joint_walk. First `settle`, then `average`.
class WalkPart {
 public:
  /// From `sweeps` as they were tracked at `offset_s`. All but the sweeps must outlive the part.
  WalkPart(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps, double offset_s,
           const JointWalkOptions& options);

  /// The first iterations, after which the result holds the offset of the last one with the sigma of its
  /// least squares. `iterated` is called after each.
  void settle(const Job& job, const std::function<void()>& iterated);
  /// The others, after which it holds their mean. Does nothing if a part did not converge.
  void average(const Job& job, const std::function<void()>& iterated);
  /// Which ends of a part stay where they were tracked.
  struct HeldEnds {
    bool begin = false, end = false;
  };
  /// Instead of both, for a part that may be long: iterations of which only the path is wanted. Counts the
  /// matches of the last one.
  MatchCount adjust(const HeldEnds& held, const Job& job, const std::function<void()>& iterated);
  /// Gives back the memory of a factor, 8 MB of a part of 10 s, which `average` would start with.
  void forget_factor() { factor_.reset(); }

  /// `sigma_s` is 0 where too few points match.
  const JointWalkPart& result() const { return result_; }
  const GuidedPath& path() const { return path_; }

 private:
  OffsetProblem cut() const;
  OffsetProblem begin();
  struct Matched {
    std::size_t stride = 1;  // every how many features
    bool one_side = false;   // whether the two sides of a wall are told apart
  };
  bool iterate(const OffsetProblem& part, bool is_last);
  std::optional<WalkEquations> equations(double knot_sigma) const;
  void step(const WalkEquations::Solution& solution);
  void conclude(const std::vector<double>& offsets_s, double sigma_s);
  double offset_sigma_s() const;
  double shift_sigma_s(std::size_t block) const;
  MatchCount match(const OffsetProblem& part, const Matched& matched);
  void forget_matches();
  void add(std::uint32_t line, const Eigen::Vector3d& p_m, const MatchResidual& match,
           const Neighbours& near);
  bool seen_from_one_side(std::uint32_t line, const Eigen::Vector3d& p_m, const Eigen::Vector3d& normal,
                          const Neighbours& near) const;
  double clustered_sigma_s(const Eigen::VectorXd& influences, double sigma_s) const;
  void insert(const PlacedSweep& sweep, const PlacedFeature& feature, FeatureMap& map);
  double turning_rad_s(const Sweep& sweep, double motor_s) const;
  std::uint32_t line_of(const PlacedSweep& sweep, const PlacedFeature& feature) const;
  Eigen::Vector3d in_map_m(const PlacedSweep& sweep, const PlacedFeature& feature) const;
  Eigen::Vector3d arm_m(std::uint32_t line, const Eigen::Vector3d& p_m) const;

  const OffsetProblem& problem_;  // of the whole walk
  const JointWalkOptions& options_;
  double tracked_at_s_;
  std::size_t first_sweep_, last_sweep_;
  std::uint32_t slices_;          // of every scan
  std::uint32_t first_scan_ = 0;  // of the recording's, that the part uses
  GuidedPath path_;
  Eigen::Vector2d jerk_sigma_;          // rad/s^3 and m/s^3
  Eigen::Vector2d acceleration_sigma_;  // rad/s^2 and m/s^2
  std::optional<JerkEvidence> evidence_;
  JointWalkPart result_;
  std::optional<WalkEquations::Solution> solution_;  // the last iteration's
  std::optional<WalkEquations::Factor> factor_;      // an earlier iteration's
  std::vector<ScanMotion> scans_;
  static constexpr std::uint32_t kNoLine = 0xffffffffu;
  std::uint32_t last_line_ = kNoLine;  // whose motion was worked out last
  // The last iteration's matches, and where their points lie.
  std::optional<ScanEquations> matches_;
  std::vector<Eigen::Vector3d> matched_m_;
};

}  // namespace sweepscope
