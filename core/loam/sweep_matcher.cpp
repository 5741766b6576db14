#include "core/loam/sweep_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {

using Eigen::Vector3d;

SweepPose pose_of(const PlacedSweep& sweep) {
  SweepPose pose;
  pose.sweep = sweep.sweep;
  pose.direction = sweep.direction;
  pose.begin_s = sweep.begin_s;
  pose.end_s = sweep.end_s;
  return pose;
}

void MatchCount::add(const std::optional<MatchResidual>& residual, double range_m, double gate_m,
                     double cap_m) {
  ++features;
  range_sum_m += range_m;
  const double distance_m = residual ? std::abs(residual->distance_m) : 0;
  const double capped_m = residual ? std::min(distance_m, cap_m) : cap_m;
  capped_sum_m += capped_m;
  capped_by_range_m2 += capped_m * range_m;
  if (!residual || !(distance_m < gate_m)) return;
  ++matches;
  matched_range_m += range_m;
  distance_sum_m += distance_m;
}

MatchCount& MatchCount::operator+=(const MatchCount& other) {
  features += other.features;
  matches += other.matches;
  distance_sum_m += other.distance_sum_m;
  capped_sum_m += other.capped_sum_m;
  range_sum_m += other.range_sum_m;
  matched_range_m += other.matched_range_m;
  capped_by_range_m2 += other.capped_by_range_m2;
  roll_moment_m2 += other.roll_moment_m2;
  roll_inertia_m2 += other.roll_inertia_m2;
  return *this;
}

void SweepMaps::insert(const PlacedSweep& sweep, const SweepPose& pose) {
  const SweepMotion motion = pose.motion();
  for (const PlacedFeature& feature : sweep.edges)
    edges.insert(motion(feature.p_in_base_m, feature.u).cast<float>(), feature.line, sweep.side);
  for (const PlacedFeature& feature : sweep.planes)
    planes.insert(motion(feature.p_in_base_m, feature.u).cast<float>(), feature.line, sweep.side);
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
    : search_{maps.edges, maps.planes, rule},
      options_(options),
      planes_(to_match<PlanePatch>(sweep.planes)),
      edges_(to_match<LinePatch>(sweep.edges)) {
  double sum_m = 0;
  for (const Matched<PlanePatch>& plane : planes_) sum_m += plane.range_m;
  for (const Matched<LinePatch>& edge : edges_) sum_m += edge.range_m;
  mean_range_m_ = sum_m / double(planes_.size() + edges_.size());
}

template <typename Patch, typename Search>
void SweepMatcher::linearise(std::vector<Matched<Patch>>& features, const SweepMotion& motion, Share share,
                             const Vector3d& pivot_m, double gate_m, const Search& search,
                             PathEquations& equations, MatchCount& count) const {
  for (std::size_t i = 0; i < features.size() && features[i].u <= share.end_u; i += share.stride) {
    Matched<Patch>& feature = features[i];
    const Vector3d p_m = motion(feature.p_in_base_m, feature.u);
    refresh(feature, p_m, search);
    const auto residual = residual_of(feature.patch, p_m);
    count.add(residual, feature.range_m, gate_m, options_.cost_cap_m);
    if (residual && residual->has_normal)
      equations.add(feature.u, distance_jacobian(p_m, residual->normal, pivot_m), residual->distance_m,
                    weight_of(residual->distance_m, feature.range_m));
  }
}

MatchCount SweepMatcher::linearise(const SweepMotion& motion, Share share, const Vector3d& pivot_m,
                                   PathEquations& equations) {
  MatchCount count;
  linearise(
      planes_, motion, share, pivot_m, options_.plane_gate_m,
      [&](const Vector3d& p_m, float range_m) { return search_.plane(p_m, range_m); }, equations, count);
  linearise(
      edges_, motion, share, pivot_m, options_.edge_gate_m,
      [&](const Vector3d& p_m, float range_m) { return search_.line(p_m, range_m); }, equations, count);
  return count;
}

template <typename Patch, typename Search>
void SweepMatcher::refresh(Matched<Patch>& feature, const Vector3d& p_m, const Search& search) const {
  if ((p_m - feature.searched_at_m).squaredNorm() < options_.reuse_within_m * options_.reuse_within_m) return;
  feature.patch = search(p_m, feature.range_m);
  feature.searched_at_m = p_m;
}

// What is far is seen by few beams, and shows how far the rig moved where floor and ceiling do not.
double SweepMatcher::weight_of(double distance_m, double range_m) const {
  const double by_range =
      std::clamp(range_m / mean_range_m_, options_.least_range_weight, options_.most_range_weight);
  return by_range * cauchy_weight(distance_m, options_.loss_width_m) /
         (options_.match_sigma_m * options_.match_sigma_m);
}

MatchCount count_sweep(const SweepMaps& maps, const PlacedSweep& sweep, const SweepPose& pose,
                       const SearchRule& rule, const MappingOptions& options, const Vector3d& motor_axis) {
  MatchCount count;
  const SweepMotion motion = pose.motion();
  PatchSearch search{maps.edges, maps.planes, rule};
  const auto place = [&](const PlacedFeature& feature) { return motion(feature.p_in_base_m, feature.u); };
  match_features(sweep, place, search,
                 [&](MatchedKind kind, const PlacedFeature& feature, const Vector3d& p_m,
                     const std::optional<MatchResidual>& residual) {
                   count.add(residual, feature.range_m, gate_m(kind, options), options.cost_cap_m);
                   if (!residual || !residual->has_normal) return;
                   // How the distance changes as the sweep turns on about the motor's axis.
                   const Pose base = pose.at(feature.u);
                   const double lever_m = (sweep.direction * (base.rotation * motor_axis))
                                              .cross(p_m - base.translation_m)
                                              .dot(residual->normal);
                   count.roll_moment_m2 += lever_m * residual->distance_m;
                   count.roll_inertia_m2 += lever_m * lever_m;
                 });
  return count;
}

}  // namespace sweepscope
