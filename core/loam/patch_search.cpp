#include "core/loam/patch_search.hpp"

#include <algorithm>

namespace sweepscope {
namespace {

// The finest level that holds enough neighbours. Gives the search radius.
std::optional<double> nearest_on_finest(const FeatureMap& map, const Eigen::Vector3f& p_m, float range_m,
                                        const SearchRule& rule, int most, int least, int min_lines,
                                        Neighbours& near) {
  const int coarsest = map.level_for(std::max(rule.radius_m, rule.radius_slope * range_m));
  for (int level = 0; level <= coarsest; ++level) {
    map.nearest(p_m, level, rule.filter, most, rule.patch.per_line, near, least);
    if (near.count >= least && near.lines >= min_lines) return map.search_radius_m(level);
  }
  return std::nullopt;
}

}  // namespace

std::optional<PlanePatch> find_plane(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m,
                                     const SearchRule& rule, Neighbours& near) {
  const auto radius_m = nearest_on_finest(map, p_m.cast<float>(), range_m, rule, rule.patch.plane_neighbours,
                                          6, rule.patch.min_lines, near);
  return radius_m ? fit_plane(near, rule.patch, *radius_m) : std::nullopt;
}

std::optional<LinePatch> find_line(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m,
                                   const SearchRule& rule, Neighbours& near) {
  const auto radius_m = nearest_on_finest(map, p_m.cast<float>(), range_m, rule, rule.patch.edge_neighbours,
                                          4, rule.patch.min_edge_lines, near);
  return radius_m ? fit_line(near, rule.patch, *radius_m) : std::nullopt;
}

}  // namespace sweepscope
