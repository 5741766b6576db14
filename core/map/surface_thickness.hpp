#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "core/geometry/map_cloud.hpp"

namespace sweepscope {

/// How the surface around a point is found. It consists of the points in a cube with an edge of three cells;
/// if they are too few, or too thick for that cube, of those in a cube with twice the edge.
struct ThicknessOptions {
  double cell_m = 0.1;         // of the finer cubes
  int doublings = 2;           // how often the cube may grow
  int min_points = 20;         // in a cube
  double max_flatness = 0.45;  // maximum spread across the surface, relative to the smaller spread along it
  double min_extent = 0.25;    // minimum spread along the surface, relative to that of an evenly filled cube
  bool both_directions = false;  // only where sweeps of both directions saw the surface
};

/// The surface around a point.
struct LocalSurface {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // of unit length; its sign has no meaning
  /// Standard deviation (m) of the points' distances from the surface; NaN where there is none.
  float thickness_m = std::numeric_limits<float>::quiet_NaN();
};

/// The surface around each point of the map. A surface may be bent: one of second degree is fitted, so that
/// pipes are thin and the corners of rooms nearly. Points of a map at a wrong offset lie in layers, one for
/// the sweeps of each direction, and both belong to the surface: 5 ms at 360 deg/s put layers 0.8 m above the
/// rig 25 mm to either side. Layers more than 0.15 m apart may count as separate surfaces. There is no
/// surface if the points are too few, collinear, in a few scan lines, or fill a volume as foliage does.
/// Sweeps of one direction alone cannot show a wrong offset: their surface is as thin as it would be at the
/// right one.
std::vector<LocalSurface> local_surfaces(const MapCloud& cloud, const ThicknessOptions& options = {});

/// The local blur: the thickness (m) of the surface around each point; NaN where there is no surface.
std::vector<float> surface_thickness_m(const MapCloud& cloud, const ThicknessOptions& options = {});

}  // namespace sweepscope
