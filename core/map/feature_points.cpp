#include "core/map/feature_points.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace sweepscope {
namespace {

struct StampedKind {
  double time_s;
  FeatureKind kind;
  bool operator<(const StampedKind& other) const {
    return time_s != other.time_s ? time_s < other.time_s : kind < other.kind;
  }
};

void append(const FeatureList& list, FeatureKind kind, std::vector<StampedKind>& stamped) {
  for (const Feature& feature : list.features) stamped.push_back({feature.time_s, kind});
}

void mark(const FeatureList& list, std::size_t scan, FeatureKind kind,
          std::span<const std::uint32_t> point_of, std::vector<ScanPoint>& points) {
  for (std::size_t i = list.scan_begin[scan]; i < list.scan_begin[scan + 1]; ++i) {
    ScanPoint& point = points[point_of[list.features[i].beam]];
    point.kind = kind;
    point.sharp = list.features[i].sharp;
  }
}

}  // namespace

std::vector<ScanPoint> scan_points(const Recording& recording, const FeatureSet& features, std::size_t scan,
                                   const FeatureOptions& options) {
  const LaserScan& line = recording.scans[scan];
  const auto ranges_m = recording.ranges(line);
  const std::vector<float> curvatures_m = line_curvatures_m(recording, scan, options);
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> point_of(line.beams);
  for (std::uint32_t beam = 0; beam < line.beams; ++beam) {
    point_of[beam] = static_cast<std::uint32_t>(points.size());
    if (!std::isfinite(ranges_m[beam])) continue;
    const double angle_rad = line.beam_angle_rad(beam);
    ScanPoint& point = points.emplace_back();
    point.p_in_laser_m =
        (ranges_m[beam] * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad))).cast<float>();
    point.beam = beam;
    point.curvature_m = curvatures_m[beam];
  }
  mark(features.planes, scan, FeatureKind::kPlane, point_of, points);
  mark(features.edges, scan, FeatureKind::kEdge, point_of, points);
  return points;
}

std::vector<FeatureKind> feature_kinds(const FeatureSet& features, const MapCloud& cloud) {
  std::vector<StampedKind> stamped;
  stamped.reserve(features.edges.features.size() + features.planes.features.size());
  append(features.edges, FeatureKind::kEdge, stamped);
  append(features.planes, FeatureKind::kPlane, stamped);
  std::sort(stamped.begin(), stamped.end());
  std::vector<FeatureKind> kinds(cloud.size(), FeatureKind::kNone);
  for_each_block(cloud.size(), 16384, [&](const auto& block) {
    for (std::size_t i = block.begin(); i < block.end(); ++i) {
      const double time_s = cloud.points[i].time_s;
      const auto at =
          std::lower_bound(stamped.begin(), stamped.end(), StampedKind{time_s, FeatureKind::kNone});
      if (at != stamped.end() && at->time_s == time_s) kinds[i] = at->kind;
    }
  });
  return kinds;
}

FeatureCloud feature_cloud(const MapCloud& cloud, std::span<const FeatureKind> kinds) {
  FeatureCloud found{MapCloud::Ptr(new MapCloud), {}};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (kinds[i] == FeatureKind::kNone) continue;
    found.cloud->push_back(cloud.points[i]);
    found.kinds.push_back(kinds[i]);
  }
  return found;
}

}  // namespace sweepscope
