#include "core/loam/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/patch_search.hpp"
#include "core/loam/path/least_squares.hpp"

namespace sweepscope {
namespace {

// The patches at a point among the neighbours within one radius.
struct PatchesWithin {
  const SweepMap& target;
  const OdometryOptions& options;
  Neighbours near{};

  double gather(const FeatureMap& map, const Eigen::Vector3d& p_m, float range_m, int most) {
    const int level = map.level_for(std::max(options.search_radius_m, options.search_radius_slope * range_m));
    map.nearest(p_m.cast<float>(), level, SweepFilter::kAny, most, options.patch.per_line, near);
    return map.search_radius_m(level);
  }
  std::optional<PlanePatch> plane(const Eigen::Vector3d& p_m, float range_m) {
    const double radius_m = gather(target.planes, p_m, range_m, options.patch.plane_neighbours);
    return fit_plane(near, options.patch, radius_m);
  }
  std::optional<LinePatch> line(const Eigen::Vector3d& p_m, float range_m) {
    const double radius_m = gather(target.edges, p_m, range_m, options.patch.edge_neighbours);
    return fit_line(near, options.patch, radius_m);
  }
};

struct Matches {
  RigidEquations equations;
  std::size_t features = 0, count = 0;
  double distance_sum_m = 0;
};

Matches matches_at(const Pose& pose, const SweepMap& target, const PlacedSweep& source,
                   const OdometryOptions& options) {
  Matches matches;
  PatchesWithin search{target, options};
  const auto place = [&](const PlacedFeature& feature) { return pose * feature.p_in_base_m; };
  match_features(source, place, search,
                 [&](MatchedKind, const PlacedFeature&, const Eigen::Vector3d& p_m, const auto& residual) {
                   ++matches.features;
                   if (!residual) return;
                   ++matches.count;
                   matches.distance_sum_m += std::abs(residual->distance_m);
                   if (residual->has_normal)
                     matches.equations.add(p_m, residual->normal, residual->distance_m,
                                           cauchy_weight(residual->distance_m, options.loss_width_m));
                 });
  return matches;
}

}  // namespace

OdometryOptions for_lines(OdometryOptions options, double line_spacing_rad) {
  options.search_radius_slope = std::max(options.search_radius_slope, 1.5 * line_spacing_rad);
  return options;
}

SweepMap map_of(const PlacedSweep& sweep) {
  SweepMap map;
  for (const PlacedFeature& feature : sweep.edges)
    map.edges.insert(feature.p_in_base_m.cast<float>(), feature.line, 1);
  for (const PlacedFeature& feature : sweep.planes)
    map.planes.insert(feature.p_in_base_m.cast<float>(), feature.line, 1);
  return map;
}

Registration register_rigidly(const SweepMap& target, const PlacedSweep& source,
                              const OdometryOptions& options) {
  Registration result;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const Matches found = matches_at(result.target_from_source, target, source, options);
    result.features = found.features;
    result.matches = found.count;
    if (found.count < std::size_t(options.min_matches)) return result;
    result.mean_distance_m = found.distance_sum_m / double(found.count);
    const Vector6d step =
        solve_determined(found.equations.matrix, found.equations.gradient,
                         options.min_eigenvalue * double(found.count), result.free_directions);
    result.target_from_source = stepped(result.target_from_source, step, Eigen::Vector3d::Zero());
    if (step.head<3>().norm() < options.step_tolerance && step.tail<3>().norm() < options.step_tolerance)
      break;
  }
  result.succeeded = result.target_from_source.translation_m.allFinite();
  return result;
}

}  // namespace sweepscope
