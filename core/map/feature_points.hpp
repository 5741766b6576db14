#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/loam/features.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// The kind of feature that a beam was selected as (Figures 2 and 3 of the paper).
enum class FeatureKind : std::uint8_t { kNone = 0, kEdge = 1, kPlane = 2 };

/// A beam's point in the scanner's plane.
struct ScanPoint {
  Eigen::Vector2f p_in_laser_m = Eigen::Vector2f::Zero();  // x forward, at angle 0
  std::uint32_t beam = 0;
  float curvature_m = 0;  // distance from the mean of its neighbours, as features are picked by; NaN at ends
  FeatureKind kind = FeatureKind::kNone;
  bool sharp = false;  // a feature that is matched; the others only build the map
};

/// All points of scan `scan` of the recording whose beams returned something, by beam, with the features
/// that were extracted from it.
std::vector<ScanPoint> scan_points(const Recording& recording, const FeatureSet& features, std::size_t scan,
                                   const FeatureOptions& options = {});

/// The kind of each point of a map. The map must have been built from the recording that the features
/// are of, and may be thinned: points are identified by the time of their beam. A point that was selected
/// both as an edge and as a plane point counts as an edge.
std::vector<FeatureKind> feature_kinds(const FeatureSet& features, const MapCloud& cloud);

/// The feature map: the edge and plane points of a map, with their kinds. Both of the same length.
struct FeatureCloud {
  MapCloud::Ptr cloud;
  std::vector<FeatureKind> kinds;
};
FeatureCloud feature_cloud(const MapCloud& cloud, std::span<const FeatureKind> kinds);

}  // namespace sweepscope
