#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <optional>
#include <vector>

#include "core/loam/feature_map.hpp"
#include "core/loam/mapping_options.hpp"
#include "core/loam/patch_search.hpp"
#include "core/loam/path/path_equations.hpp"
#include "core/loam/path/sweep_pose.hpp"
#include "core/loam/sweep_features.hpp"

namespace sweepscope {

/// The counts behind equations 6 and 7, a cost over all sharp features in which an unmatched one counts as
/// the cap, and the turn about the motor's axis that minimises the residuals of the matches.
struct MatchCount {
  std::size_t features = 0, matches = 0;           // tried; those with a patch near enough
  double distance_sum_m = 0;                       // of the matches
  double capped_sum_m = 0;                         // of all features, each at most at the cap
  double range_sum_m = 0, matched_range_m = 0;     // of all features, and of the matches
  double capped_by_range_m2 = 0;                   // the sum of capped distance times range
  double roll_moment_m2 = 0, roll_inertia_m2 = 0;  // sums over all patches found

  /// 0 without matches.
  double mean_distance_m() const { return matches == 0 ? 0.0 : distance_sum_m / double(matches); }
  /// The mean over all features, each at most at the cap; 0 without features.
  double capped_cost_m() const { return features == 0 ? 0.0 : capped_sum_m / double(features); }
  /// Of the features, each with its range as the weight, what matches, from 0 to 1. Most features lie near,
  /// on the floor, and match wherever the rig is: unweighted, a walk that was lost looked like one that was
  /// not.
  double matched_part() const { return range_sum_m > 0 ? matched_range_m / range_sum_m : 0.0; }
  /// The capped cost with the same weights.
  double misfit_m() const { return range_sum_m > 0 ? capped_by_range_m2 / range_sum_m : 0.0; }
  /// Of the sweeps against those of the other direction, in their direction of turning.
  double roll_rad() const { return roll_inertia_m2 > 0 ? roll_moment_m2 / roll_inertia_m2 : 0.0; }
  /// Adds one feature, with a residual where a patch was found.
  void add(const std::optional<MatchResidual>& residual, double range_m, double gate_m, double cap_m);
  /// Adds the counts and sums of another set of features.
  MatchCount& operator+=(const MatchCount& other);
};

/// The distance beyond which a feature does not match.
inline double gate_m(MatchedKind kind, const MappingOptions& options) {
  return kind == MatchedKind::kPlane ? options.plane_gate_m : options.edge_gate_m;
}

/// A sweep's number, direction and times, at the map's origin.
SweepPose pose_of(const PlacedSweep& sweep);

/// The map that LOAM keeps of the edges and the planes seen so far.
struct SweepMaps {
  FeatureMap edges, planes;  // in the frame of the map

  /// Adds the features of a sweep, each at the pose of its own instant.
  void insert(const PlacedSweep& sweep, const SweepPose& pose);
};

/// How a map is searched; `grown`: after it holds several sweeps, it is searched less widely.
SearchRule search_rule(const MappingOptions& options, bool grown, SweepFilter filter);

/// One sweep's matches with the map, kept from iteration to iteration while their points hardly move.
class SweepMatcher {
 public:
  /// All must outlive it.
  SweepMatcher(const SweepMaps& maps, const PlacedSweep& sweep, const SearchRule& rule,
               const MappingOptions& options);

  /// Which features are matched: those up to `end_u`, one in `stride`.
  struct Share {
    double end_u;        // the fraction of the sweep that is known
    std::size_t stride;  // every how many features are matched
  };
  /// Adds the matches at the given motion to the equations, the knots' steps taken about `pivot_m`; counts
  /// them too.
  MatchCount linearise(const SweepMotion& motion, Share share, const Eigen::Vector3d& pivot_m,
                       PathEquations& equations);

 private:
  // A feature to be matched, and the patch that it was matched to last.
  template <typename Patch>
  struct Matched {
    Eigen::Vector3d p_in_base_m;
    double u;
    float range_m;
    std::optional<Patch> patch = std::nullopt;
    Eigen::Vector3d searched_at_m = Eigen::Vector3d::Constant(1e30);
  };
  template <typename Patch>
  static std::vector<Matched<Patch>> to_match(const std::vector<PlacedFeature>& features);
  template <typename Patch, typename Search>
  void linearise(std::vector<Matched<Patch>>& features, const SweepMotion& motion, Share share,
                 const Eigen::Vector3d& pivot_m, double gate_m, const Search& search,
                 PathEquations& equations, MatchCount& count) const;
  template <typename Patch, typename Search>
  void refresh(Matched<Patch>& feature, const Eigen::Vector3d& p_m, const Search& search) const;
  double weight_of(double distance_m, double range_m) const;

  PatchSearch search_;
  const MappingOptions& options_;
  std::vector<Matched<PlanePatch>> planes_;
  std::vector<Matched<LinePatch>> edges_;
  double mean_range_m_;  // of these; NaN without any
};

/// A sweep's matches at a pose, nothing solved for; `motor_axis` in the base frame.
MatchCount count_sweep(const SweepMaps& maps, const PlacedSweep& sweep, const SweepPose& pose,
                       const SearchRule& rule, const MappingOptions& options,
                       const Eigen::Vector3d& motor_axis);

}  // namespace sweepscope
