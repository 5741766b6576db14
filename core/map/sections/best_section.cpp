#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/map/sections/cross_section.hpp"
#include "core/map/sections/section_points.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kSearchPoints = 700'000;  // of a map, to find faces by
constexpr std::size_t kMaxCandidates = 60;

// Where the rig was and how its motor's axis pointed, linear between the path's poses.
class RigReader {
 public:
  RigReader(std::span<const StampedPose> path, const Eigen::Vector3d& axis_in_base) : path_(path) {
    for (const StampedPose& pose : path) axes_.push_back(pose.orientation * axis_in_base);
  }

  struct Rig {
    Eigen::Vector3d position_m, axis;
  };
  Rig at(double time_s) const {
    const auto later =
        std::lower_bound(path_.begin(), path_.end(), time_s,
                         [](const StampedPose& pose, double t_s) { return pose.time_s < t_s; });
    if (later == path_.begin()) return {path_.front().position_m, axes_.front()};
    if (later == path_.end()) return {path_.back().position_m, axes_.back()};
    const auto i = later - path_.begin();
    const double u = (time_s - path_[i - 1].time_s) / (path_[i].time_s - path_[i - 1].time_s);
    return {(1 - u) * path_[i - 1].position_m + u * path_[i].position_m,
            ((1 - u) * axes_[i - 1] + u * axes_[i]).normalized()};
  }

 private:
  std::span<const StampedPose> path_;
  std::vector<Eigen::Vector3d> axes_;
};

// A map thinned, and its surfaces.
struct Surfaces {
  MapCloud cloud;
  std::vector<LocalSurface> surfaces;
  double median_thickness_m = std::numeric_limits<double>::infinity();
};

// Whole runs of beams in turn would leave out scan lines; single beams thin all alike.
template <typename Points>
Points every_nth(const Points& points, std::size_t stride) {
  Points part;
  for (std::size_t i = 0; i < points.size(); i += stride) part.push_back(points[i]);
  return part;
}

Surfaces surfaces_of(const MapOnPath& map) {
  const std::size_t stride = 1 + (map.cloud->size() - 1) / kSearchPoints;
  Surfaces found;
  found.cloud = every_nth(*map.cloud, stride);
  const auto take = [&](std::vector<LocalSurface> surfaces, const std::optional<MapThickness>& of_map) {
    found.surfaces = std::move(surfaces);
    if (of_map) found.median_thickness_m = of_map->median_m;
  };
  if (map.thickness != nullptr) {
    take(every_nth(map.thickness->surfaces, stride), map.thickness->map);
  } else {
    SurfaceThickness measured = surface_thickness(found.cloud);
    take(std::move(measured.surfaces), measured.map);
  }
  return found;
}

// A point on a vertical surface high above or deep below the rig.
struct WallPoint {
  std::uint64_t place;  // the column of the map and the surface's direction, as one number
  std::uint32_t point;
  float lever_m, normal_rad;  // direction in [0, pi)
};

std::vector<WallPoint> wall_points(const Surfaces& map, const RigReader& rig, const SectionSearch& search) {
  constexpr float kMaxUpright = 0.15f;
  constexpr int kDirections = 6;
  std::vector<WallPoint> found;
  for (std::size_t i = 0; i < map.surfaces.size(); ++i) {
    const LocalSurface& surface = map.surfaces[i];
    if (std::isnan(surface.thickness_m) || std::abs(surface.normal.z()) > kMaxUpright) continue;
    const MapPoint& p = map.cloud.points[i];
    if (search.near_m && (Eigen::Vector2d(p.x, p.y) - *search.near_m).norm() > search.near_radius_m) continue;
    const auto at = rig.at(p.time_s);
    const Eigen::Vector3d from_rig_m = p.getVector3fMap().cast<double>() - at.position_m;
    if (std::abs(from_rig_m.z()) < search.min_height_m) continue;
    double normal_rad = std::atan2(surface.normal.y(), surface.normal.x());
    if (normal_rad < 0) normal_rad += std::numbers::pi;
    const int direction =
        static_cast<int>(std::lround(normal_rad / std::numbers::pi * kDirections)) % kDirections;
    const auto column = [&](float value_m) {
      return static_cast<std::uint64_t>(std::floor(value_m / search.length_m) + (1 << 24));
    };
    const std::uint64_t above = from_rig_m.z() > 0 ? 1 : 0;
    found.push_back(
        {(column(p.x) << 32 | column(p.y) << 4) | static_cast<std::uint64_t>(direction) << 1 | above,
         static_cast<std::uint32_t>(i),
         static_cast<float>(surface.normal.cast<double>().dot(at.axis.cross(from_rig_m))),
         static_cast<float>(normal_rad)});
  }
  std::sort(found.begin(), found.end(), [](const WallPoint& a, const WallPoint& b) {
    return a.place != b.place ? a.place < b.place : a.point < b.point;
  });
  return found;
}

struct SectionCandidate {
  CrossSection section;
  double lever_m = 0, promise = 0;
};

// One column's points of one direction as a section; nothing where they are too few or of one turning alone.
std::optional<SectionCandidate> candidate_of(std::span<const WallPoint> points, const MapCloud& cloud,
                                             double points_each, const SectionSearch& search) {
  const double count = points_each * static_cast<double>(points.size());
  if (count < static_cast<double>(search.min_points)) return std::nullopt;
  std::vector<float> heights_m;
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero(), doubled = Eigen::Vector2d::Zero();
  std::vector<float> levers_m;
  std::size_t forward = 0;
  for (const WallPoint& point : points) {
    const MapPoint& p = cloud.points[point.point];
    heights_m.push_back(p.z);
    sum_m += Eigen::Vector2d(p.x, p.y);
    // A normal's sign has no meaning: of the doubled angle a mean can be taken.
    doubled += Eigen::Vector2d(std::cos(2 * point.normal_rad), std::sin(2 * point.normal_rad));
    levers_m.push_back(std::abs(point.lever_m));
    forward += p.sweep % 2;
  }
  const std::size_t lesser = std::min(forward, points.size() - forward);
  if (lesser * 5 < points.size()) return std::nullopt;
  std::sort(heights_m.begin(), heights_m.end());
  SectionCandidate candidate;
  candidate.section.at_m = sum_m / static_cast<double>(points.size());
  candidate.section.normal_rad = std::atan2(doubled.y(), doubled.x()) / 2;
  candidate.section.length_m = search.length_m;
  candidate.section.reach_m = search.reach_m;
  candidate.section.from_m = heights_m[heights_m.size() / 50];
  candidate.section.to_m = heights_m[heights_m.size() - 1 - heights_m.size() / 50];
  // A mean would hide the points that a wrong offset leaves where they are: they make a narrow peak of their
  // own.
  const auto quarter = levers_m.begin() + static_cast<std::ptrdiff_t>(levers_m.size() / 4);
  std::nth_element(levers_m.begin(), quarter, levers_m.end());
  candidate.lever_m = *quarter;
  // Beyond some thousands, more points do not make the profile's noise matter less.
  candidate.promise = candidate.lever_m * std::sqrt(std::min(count, 4000.0));
  return candidate;
}

std::vector<SectionCandidate> candidates(const Surfaces& map, double points_each, const RigReader& rig,
                                         const SectionSearch& search) {
  const std::vector<WallPoint> points = wall_points(map, rig, search);
  std::vector<SectionCandidate> found;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() && points[end].place == points[begin].place) ++end;
    const auto candidate =
        candidate_of(std::span(points).subspan(begin, end - begin), map.cloud, points_each, search);
    if (candidate) found.push_back(*candidate);
    begin = end;
  }
  std::stable_sort(found.begin(), found.end(), [](const SectionCandidate& a, const SectionCandidate& b) {
    return a.promise > b.promise;
  });
  if (found.size() > kMaxCandidates) found.resize(kMaxCandidates);
  return found;
}

// The points of one section in one map.
struct SectionPoints {
  const MapCloud* cloud;
  std::vector<std::uint32_t> near;

  Profile profile(const CrossSection& section) const {
    const auto inside = points_inside(*cloud, near, section);
    return profile_of(distances_across_m(*cloud, inside, section), section.reach_m);
  }
};

// The profile that the points would have if sweeps of either direction were turned the other way.
Profile turned_profile(const SectionPoints& points, const CrossSection& section, const RigReader& rig,
                       double error_rad) {
  const auto inside = points_inside(*points.cloud, points.near, section);
  std::vector<double> distances_m = distances_across_m(*points.cloud, inside, section), kept_m;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const MapPoint& p = points.cloud->points[inside[i]];
    const auto at = rig.at(p.time_s);
    const double lever_m =
        section.across().dot(at.axis.cross(p.getVector3fMap().cast<double>() - at.position_m));
    distances_m[i] += (p.sweep % 2 == 0 ? 1 : -1) * error_rad * lever_m;
    if (std::abs(distances_m[i]) <= section.reach_m) kept_m.push_back(distances_m[i]);
  }
  return profile_of(kept_m, section.reach_m);
}

// Whether the face is a plane for its whole length, and not a round column or a corner: in each part of the
// length there are points, and their median is near the plane.
bool is_plane(const SectionPoints& points, const CrossSection& face) {
  constexpr std::size_t kParts = 5;
  constexpr double kMinShare = 0.25;  // of an even share of the points
  constexpr double kMaxBend_m = 0.006;
  const auto inside = points_inside(*points.cloud, points.near, face);
  const std::vector<double> distances_m = distances_across_m(*points.cloud, inside, face);
  std::array<std::vector<double>, kParts> parts;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Eigen::Vector3d from_middle_m =
        points.cloud->points[inside[i]].getVector3fMap().cast<double>() - face.middle_m();
    const double along = from_middle_m.dot(face.along()) / face.length_m + 0.5;
    parts[static_cast<std::size_t>(std::clamp(along, 0.0, 0.999) * kParts)].push_back(distances_m[i]);
  }
  return std::ranges::all_of(parts, [&](const std::vector<double>& part) {
    return static_cast<double>(part.size()) * kParts >= kMinShare * static_cast<double>(inside.size()) &&
           !part.empty() && std::abs(median(part)) <= kMaxBend_m;
  });
}

struct Measured {
  FoundSection found;
  double score = 0;
};

// The section fitted to its face, with the widths of all maps; none if one is not determined.
std::optional<Measured> measured(const SectionCandidate& candidate, std::size_t sharpest,
                                 const std::vector<SectionPoints>& per_map, const RigReader& rig,
                                 const SectionSearch& search) {
  const SectionPoints& sharp = per_map[sharpest];
  const auto fitted =
      face_of(*sharp.cloud, points_inside(*sharp.cloud, sharp.near, candidate.section), candidate.section);
  if (!fitted || !is_plane(sharp, *fitted)) return std::nullopt;
  std::vector<Profile> profiles;
  for (const SectionPoints& points : per_map) profiles.push_back(points.profile(*fitted));
  Measured result{{*fitted, sharpest, {}, candidate.lever_m}, 0};
  for (const Profile& profile : profiles)
    result.found.widths_mm.push_back(profile.width_at_half_height_mm.value_or(0));
  const double sharp_mm = result.found.widths_mm[sharpest];
  if (per_map.size() == 1) profiles.push_back(turned_profile(sharp, *fitted, rig, search.error_rad));
  // A face blurred beyond the section's reach has no width to compare.
  constexpr double kMinPart = 0.7;
  for (const Profile& profile : profiles) {
    const bool inside =
        static_cast<double>(profile.points) >= kMinPart * static_cast<double>(profiles[sharpest].points);
    if (!profile.width_at_half_height_mm || !inside) return std::nullopt;
    result.score = std::max(result.score, *profile.width_at_half_height_mm / sharp_mm);
  }
  if (sharp_mm > search.max_width_mm || profiles[sharpest].points < search.min_points) return std::nullopt;
  return result;
}

}  // namespace

std::optional<FoundSection> best_section(std::span<const MapOnPath> maps, const SectionSearch& search) {
  for (const MapOnPath& map : maps)
    if (map.cloud->empty() || map.path.empty()) return std::nullopt;
  if (maps.empty()) return std::nullopt;
  std::vector<Surfaces> surfaces;
  for (const MapOnPath& map : maps) surfaces.push_back(surfaces_of(map));
  const auto sharpest =
      static_cast<std::size_t>(std::min_element(surfaces.begin(), surfaces.end(),
                                                [](const Surfaces& a, const Surfaces& b) {
                                                  return a.median_thickness_m < b.median_thickness_m;
                                                }) -
                               surfaces.begin());
  const double points_each = double(maps[sharpest].cloud->size()) / double(surfaces[sharpest].cloud.size());
  const RigReader rig(maps[sharpest].path, search.motor_axis.normalized());
  const std::vector<SectionCandidate> tried = candidates(surfaces[sharpest], points_each, rig, search);
  std::vector<CrossSection> sections;
  for (const SectionCandidate& candidate : tried) sections.push_back(candidate.section);

  std::vector<std::vector<SectionPoints>> points(tried.size());  // per candidate and map
  for (const MapOnPath& map : maps) {
    auto near = points_near(*map.cloud, sections);
    for (std::size_t i = 0; i < tried.size(); ++i) points[i].push_back({map.cloud, std::move(near[i])});
  }
  std::vector<std::optional<Measured>> found(tried.size());
  for_each_index(tried.size(),
                 [&](std::size_t i) { found[i] = measured(tried[i], sharpest, points[i], rig, search); });
  const Measured* best = nullptr;
  for (const auto& section : found)
    if (section && (best == nullptr || section->score > best->score)) best = &*section;
  if (best == nullptr) return std::nullopt;
  return best->found;
}

}  // namespace sweepscope
