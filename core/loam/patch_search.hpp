#pragma once

#include <optional>

#include "core/loam/matching.hpp"
#include "core/loam/sweep_features.hpp"

namespace sweepscope {

/// How a map is searched for the surface at a point.
struct SearchRule {
  PatchOptions patch;                          // what counts as a plane or a line
  double radius_m = 0.5, radius_slope = 0.12;  // at least the first, and the second times the range
  SweepFilter filter = SweepFilter::kAny;      // which sweeps a patch may come from
};

/// The plane, or the line, through the map's points about `p_m`, seen from `range_m`: on the finest level of
/// the map that holds enough neighbours, since large patches bend round corners. Nothing where even the
/// coarsest level allowed is too sparse, or they do not fit. `near` then holds the neighbours it was fitted
/// to.
std::optional<PlanePatch> find_plane(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m,
                                     const SearchRule& rule, Neighbours& near);
/// The same for the line.
std::optional<LinePatch> find_line(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m,
                                   const SearchRule& rule, Neighbours& near);

/// Searches two maps by a rule.
struct PatchSearch {
  const FeatureMap& edge_map;   // of features on corners
  const FeatureMap& plane_map;  // of features on flat surfaces
  SearchRule rule;              // how far it searches, and what it accepts
  Neighbours near{};            // those of the last patch

  /// The plane at a point that was measured from `range_m` away.
  std::optional<PlanePatch> plane(const Eigen::Vector3d& p_m, float range_m) {
    return find_plane(plane_map, p_m, range_m, rule, near);
  }
  /// The same for a line.
  std::optional<LinePatch> line(const Eigen::Vector3d& p_m, float range_m) {
    return find_line(edge_map, p_m, range_m, rule, near);
  }
};

/// What a feature is matched to.
enum class MatchedKind { kPlane, kEdge };

/// Matches a sweep's sharp features, planes first: `place(feature)` says where a feature lies in the map,
/// `search` finds its patch, as PatchSearch does, and `use(kind, feature, p_m, residual)` gets each one, with
/// a residual where it has a patch.
template <typename Place, typename Search, typename Use>
void match_features(const PlacedSweep& sweep, const Place& place, Search& search, const Use& use) {
  for (const PlacedFeature& feature : sweep.planes) {
    if (!feature.sharp) continue;
    const Eigen::Vector3d p_m = place(feature);
    use(MatchedKind::kPlane, feature, p_m, residual_of(search.plane(p_m, feature.range_m), p_m));
  }
  for (const PlacedFeature& feature : sweep.edges) {
    if (!feature.sharp) continue;
    const Eigen::Vector3d p_m = place(feature);
    use(MatchedKind::kEdge, feature, p_m, residual_of(search.line(p_m, feature.range_m), p_m));
  }
}

}  // namespace sweepscope
