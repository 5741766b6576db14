#pragma once

#include <optional>

#include "core/loam/matching.hpp"

namespace sweepscope {

/// How a map is searched for the surface at a point.
struct SearchRule {
  PatchOptions patch;
  double radius_m = 0.5, radius_slope = 0.12;  // at least the first, and the second times the range
  SweepFilter filter = SweepFilter::kAny;
};

/// The plane, or the line, through the map's points about `p_m`, seen from `range_m`: on the finest level of
/// the map that holds enough neighbours, since large patches bend round corners. Nothing where even the
/// coarsest level allowed is too sparse, or they do not fit. `near` then holds the neighbours it was fitted
/// to.
std::optional<PlanePatch> find_plane(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m,
                                     const SearchRule& rule, Neighbours& near);
std::optional<LinePatch> find_line(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m,
                                   const SearchRule& rule, Neighbours& near);

}  // namespace sweepscope
