#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/job.hpp"

namespace sweepscope {

struct ThicknessOptions {
  double min_radius_m =
      0.1;               // of the smallest neighbourhood; the larger ones have twice and four times as much
  double reach_m = 0.4;  // to either side of a point, along the normal, within which layers are found
  bool both_directions = false;  // also of maps whose sweeps all turned in the same direction
};

/// Whether the surface around a point has a thickness.
enum class SurfaceKind : std::uint8_t {
  kUnknown,  // too few points, too few scan lines, or seen by sweeps of one direction alone
  kEdge,     // not flat within a single sweep: an edge, a corner, a strong bend, foliage
  kFlat,
};

/// The surface around a point.
struct LocalSurface {
  Eigen::Vector3f normal =
      Eigen::Vector3f::Zero();  // of unit length, in the map frame; its sign has no meaning
  float thickness_m = std::numeric_limits<float>::quiet_NaN();  // NaN unless the surface is flat
  SurfaceKind kind = SurfaceKind::kUnknown;
};

/// The thickness of a whole map. Each cube of min_radius_m with a flat surface counts once, however many
/// points it holds: what the rig passed closely is dense, and a wrong offset hardly moves it.
struct MapThickness {
  double median_m = 0;
  double p90_m = 0;      // 90 % of the map is thinner
  double flat_part = 0;  // of all cubes that hold points
  double edge_part = 0;  // of all cubes: those that hold points on edges and no flat surface
};

/// "median thickness 21 mm, 90 % under 34 mm"
std::string in_words(const MapThickness& map);

/// The blur of a map.
struct SurfaceThickness {
  std::vector<LocalSurface> surfaces;  // around each point of the map, in its order
  std::optional<MapThickness> map;     // absent if no surface is flat
};

/// The thickness of the surfaces of a map: the width at half height of the points across each surface, as the
/// profile tool (profile_across) measures one wall. A single layer with normal noise has 2.355 standard
/// deviations, two sharp layers the distance between them. It is found from the quantiles that hold the
/// middle 76 % of the points, which know all layers: the profile tool loses those less than half as dense as
/// another.
///
/// Around a point the neighbourhood is a disc of 0.4 m radius, and half and a quarter of it where the larger
/// one holds an edge. Its normal comes from the spread of points within single sweeps: a sweep's points lie
/// on their surface whatever the offset. Across the disc all layers within reach_m count that sweeps of
/// opposite directions, one soon after the other, put the same surface on; surfaces that sweeps of both
/// directions measured at one place, such as the two sides of a thin wall, are distinguished. What is not
/// flat within single sweeps, compared with the range noise of the whole map, is an edge. A map whose points
/// do not say which sweep they are of has one thickness for all points across a disc, and no edges. See
/// section 17 of docs/algorithms.md.
///
/// In parallel, the same result for any number of threads. If `job` is cancelled the result is unfinished.
SurfaceThickness surface_thickness(const MapCloud& cloud, const ThicknessOptions& options = {},
                                   const Job& job = {});

}  // namespace sweepscope
