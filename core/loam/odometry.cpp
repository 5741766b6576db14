#include "core/loam/odometry.hpp"

#include "core/loam/least_squares.hpp"

namespace sweepscope {
namespace {

struct Accumulated {
  Matrix6d matrix = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  std::size_t features = 0, matches = 0;
  double distance_sum_m = 0;

  void add(const Eigen::Vector3d& p_m, const Eigen::Vector3d& normal, double distance_m, double weight) {
    const Vector6d row = distance_jacobian(p_m, normal, Eigen::Vector3d::Zero());
    matrix.noalias() += weight * row * row.transpose();
    gradient += weight * distance_m * row;
  }
};

void add_planes(const SweepMap& target, const PlacedSweep& source, const Pose& pose,
                const OdometryOptions& options, Accumulated& sum) {
  Neighbours near;
  for (const PlacedFeature& feature : source.planes) {
    if (!feature.sharp) continue;
    ++sum.features;
    const Eigen::Vector3d p_m = pose * feature.p_in_base_m;
    const int level = target.planes.level_for(
        std::max(options.search_radius_m, options.search_radius_slope * feature.range_m));
    target.planes.nearest(p_m.cast<float>(), level, SweepFilter::kAny, options.patch.plane_neighbours,
                          options.patch.per_line, near);
    const auto plane = fit_plane(near, options.patch, target.planes.search_radius_m(level));
    if (!plane) continue;
    const double distance_m = (p_m - plane->centre_m).dot(plane->normal);
    sum.add(p_m, plane->normal, distance_m, cauchy_weight(distance_m, options.loss_width_m));
    sum.distance_sum_m += std::abs(distance_m);
    ++sum.matches;
  }
}

void add_edges(const SweepMap& target, const PlacedSweep& source, const Pose& pose,
               const OdometryOptions& options, Accumulated& sum) {
  Neighbours near;
  for (const PlacedFeature& feature : source.edges) {
    if (!feature.sharp) continue;
    ++sum.features;
    const Eigen::Vector3d p_m = pose * feature.p_in_base_m;
    const int level = target.edges.level_for(
        std::max(options.search_radius_m, options.search_radius_slope * feature.range_m));
    target.edges.nearest(p_m.cast<float>(), level, SweepFilter::kAny, options.patch.edge_neighbours,
                         options.patch.per_line, near);
    const auto line = fit_line(near, options.patch, target.edges.search_radius_m(level));
    if (!line) continue;
    const Eigen::Vector3d away_m = from_line(*line, p_m);
    const double distance_m = away_m.norm();
    if (distance_m > 1e-9)
      sum.add(p_m, away_m / distance_m, distance_m, cauchy_weight(distance_m, options.loss_width_m));
    sum.distance_sum_m += distance_m;
    ++sum.matches;
  }
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
    Accumulated sum;
    add_planes(target, source, result.target_from_source, options, sum);
    add_edges(target, source, result.target_from_source, options, sum);
    result.features = sum.features;
    result.matches = sum.matches;
    if (sum.matches < std::size_t(options.min_matches)) return result;
    result.mean_distance_m = sum.distance_sum_m / double(sum.matches);
    const Vector6d step = solve_determined(
        sum.matrix, sum.gradient, options.min_eigenvalue * double(sum.matches), result.free_directions);
    result.target_from_source = stepped(result.target_from_source, step, Eigen::Vector3d::Zero());
    if (step.head<3>().norm() < options.step_tolerance && step.tail<3>().norm() < options.step_tolerance)
      break;
  }
  result.succeeded = result.target_from_source.translation_m.allFinite();
  return result;
}

}  // namespace sweepscope
