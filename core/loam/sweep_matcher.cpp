#include "core/loam/sweep_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/least_squares.hpp"

namespace sweepscope {

using Eigen::Vector3d;

void MatchCount::add(bool found, double distance_m, double gate_m, double cap_m) {
  ++features;
  capped_sum_m += found ? std::min(distance_m, cap_m) : cap_m;
  if (!found || !(distance_m < gate_m)) return;
  ++matches;
  distance_sum_m += distance_m;
}

MatchCount& MatchCount::operator+=(const MatchCount& other) {
  features += other.features;
  matches += other.matches;
  distance_sum_m += other.distance_sum_m;
  capped_sum_m += other.capped_sum_m;
  roll_moment_m2 += other.roll_moment_m2;
  roll_inertia_m2 += other.roll_inertia_m2;
  return *this;
}

void SweepMaps::insert(const PlacedSweep& sweep, const SweepPose& pose) {
  const SweepMotion motion = pose.motion();
  for (const PlacedFeature& feature : sweep.edges)
    edges.insert(motion(feature.p_in_base_m, feature.u).cast<float>(), feature.line, sweep.direction);
  for (const PlacedFeature& feature : sweep.planes)
    planes.insert(motion(feature.p_in_base_m, feature.u).cast<float>(), feature.line, sweep.direction);
}

SearchRule search_rule(const MappingOptions& options, bool grown, SweepFilter filter) {
  SearchRule rule{options.patch, options.search_radius_m, options.search_radius_slope, filter};
  if (!grown) {
    rule.patch.per_line = 3;
    rule.patch.min_lines = 3;
    rule.radius_slope = std::max(rule.radius_slope, 0.25);
  }
  return rule;
}

template <typename Patch>
std::vector<SweepMatcher::Matched<Patch>> SweepMatcher::to_match(const std::vector<PlacedFeature>& features) {
  std::vector<Matched<Patch>> found;
  found.reserve(features.size() / 2);
  for (const PlacedFeature& feature : features)
    if (feature.sharp) found.push_back({feature.p_in_base_m, feature.u, feature.range_m});
  return found;
}

SweepMatcher::SweepMatcher(const SweepMaps& maps, const PlacedSweep& sweep, const SearchRule& rule,
                           const MappingOptions& options)
    : maps_(maps),
      rule_(rule),
      options_(options),
      planes_(to_match<PlanePatch>(sweep.planes)),
      edges_(to_match<LinePatch>(sweep.edges)) {}

MatchCount SweepMatcher::linearise(const SweepMotion& motion, Share share, const Vector3d& pivot_m,
                                   PathEquations& equations) {
  MatchCount count;
  for (std::size_t i = 0; i < planes_.size() && planes_[i].u <= share.end_u; i += share.stride) {
    Matched<PlanePatch>& feature = planes_[i];
    const Vector3d p_m = motion(feature.p_in_base_m, feature.u);
    refresh(feature, p_m, [&] { return find_plane(maps_.planes, p_m, feature.range_m, rule_, near_); });
    const auto& plane = feature.patch;
    const double distance_m = plane ? (p_m - plane->centre_m).dot(plane->normal) : 0.0;
    count.add(plane.has_value(), std::abs(distance_m), options_.plane_gate_m, options_.cost_cap_m);
    if (plane)
      equations.add(feature.u, distance_jacobian(p_m, plane->normal, pivot_m), distance_m,
                    weight_of(distance_m));
  }
  for (std::size_t i = 0; i < edges_.size() && edges_[i].u <= share.end_u; i += share.stride) {
    Matched<LinePatch>& feature = edges_[i];
    const Vector3d p_m = motion(feature.p_in_base_m, feature.u);
    refresh(feature, p_m, [&] { return find_line(maps_.edges, p_m, feature.range_m, rule_, near_); });
    const auto& line = feature.patch;
    const Vector3d away_m = line ? from_line(*line, p_m) : Vector3d::Zero();
    const double distance_m = away_m.norm();
    count.add(line.has_value(), distance_m, options_.edge_gate_m, options_.cost_cap_m);
    if (distance_m > 1e-9)
      equations.add(feature.u, distance_jacobian(p_m, away_m / distance_m, pivot_m), distance_m,
                    weight_of(distance_m));
  }
  return count;
}

template <typename Patch, typename Search>
void SweepMatcher::refresh(Matched<Patch>& feature, const Vector3d& p_m, const Search& search) const {
  if ((p_m - feature.searched_at_m).squaredNorm() < options_.reuse_within_m * options_.reuse_within_m) return;
  feature.patch = search();
  feature.searched_at_m = p_m;
}

double SweepMatcher::weight_of(double distance_m) const {
  return cauchy_weight(distance_m, options_.loss_width_m) / (options_.match_sigma_m * options_.match_sigma_m);
}

MatchCount count_sweep(const SweepMaps& maps, const PlacedSweep& sweep, const SweepPose& pose,
                       const SearchRule& rule, const MappingOptions& options, const Vector3d& motor_axis) {
  MatchCount count;
  const SweepMotion motion = pose.motion();
  Neighbours near;
  const auto add_roll = [&](const PlacedFeature& feature, const Vector3d& p_m, const Vector3d& normal,
                            double distance_m) {
    // How the distance changes as the sweep turns on about the motor's axis.
    const Pose base = pose.at(feature.u);
    const double lever_m =
        (sweep.direction * (base.rotation * motor_axis)).cross(p_m - base.translation_m).dot(normal);
    count.roll_moment_m2 += lever_m * distance_m;
    count.roll_inertia_m2 += lever_m * lever_m;
  };
  for (const PlacedFeature& feature : sweep.planes) {
    if (!feature.sharp) continue;
    const Vector3d p_m = motion(feature.p_in_base_m, feature.u);
    const auto plane = find_plane(maps.planes, p_m, feature.range_m, rule, near);
    const double distance_m = plane ? (p_m - plane->centre_m).dot(plane->normal) : 0.0;
    count.add(plane.has_value(), std::abs(distance_m), options.plane_gate_m, options.cost_cap_m);
    if (plane) add_roll(feature, p_m, plane->normal, distance_m);
  }
  for (const PlacedFeature& feature : sweep.edges) {
    if (!feature.sharp) continue;
    const Vector3d p_m = motion(feature.p_in_base_m, feature.u);
    const auto line = find_line(maps.edges, p_m, feature.range_m, rule, near);
    const Vector3d away_m = line ? from_line(*line, p_m) : Vector3d::Zero();
    const double distance_m = away_m.norm();
    count.add(line.has_value(), distance_m, options.edge_gate_m, options.cost_cap_m);
    if (distance_m > 1e-9) add_roll(feature, p_m, away_m / distance_m, distance_m);
  }
  return count;
}

}  // namespace sweepscope
