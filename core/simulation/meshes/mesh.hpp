#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

/// Triangle meshes and the parts that scenes are built from. Metres, z up. `albedo` in [0, 1] is the
/// brightness of a surface for the laser.
namespace sweepscope::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A flat piece of a surface.
struct Triangle {
  Vector3d a, b, c;     // corners in the world, in m
  double albedo = 0.5;  // the fraction of light that it sends back
};

/// The placement of a part: rotated about z, then moved.
struct Placement {
  double x_m = 0, y_m = 0, z_m = 0;  // the position of its origin in the world
  double yaw_deg = 0;                // about z, before it is moved
};

/// Surfaces that beams are traced to.
struct Mesh {
  std::vector<Triangle> triangles;  // in no particular order

  /// Adds the triangles of a part at a placement. Gives this mesh.
  Mesh& add(const Mesh& part, const Placement& placement = {});
  /// The corners in order around a flat convex polygon.
  Mesh& add_polygon(std::span<const Vector3d> corners, double albedo);
  /// Adds the six sides of a box between two corners. Gives this mesh.
  Mesh& add_box(const Vector3d& low, const Vector3d& high, double albedo = 0.5);
};

/// An axis-parallel box.
Mesh box(const Vector3d& low, const Vector3d& high, double albedo = 0.5);

/// A column on z = 0 with `sides` faces, of circumradius bottom_m below and top_m above, closed at both ends.
Mesh frustum(int sides, double bottom_m, double top_m, double height_m, double albedo = 0.5);
/// An upright prism on z = 0 about the z axis, with corners at `radius_m`.
Mesh prism(int sides, double radius_m, double height_m, double albedo = 0.5);

/// A round rod between two points.
Mesh rod(const Vector3d& from, const Vector3d& to, double radius_m, double albedo = 0.5, int sides = 6);

/// A profile in the x-z plane (corners in order, convex), stretched from y = 0 to y = depth_m.
Mesh extrusion(std::span<const Vector2d> profile_xz, double depth_m, double albedo = 0.5);

/// A crown, hedge or boulder: a sphere of facets with the half axes given, centre at the origin, its corners
/// pushed in and out by up to `roughness` of the radius.
Mesh boulder(const Vector3d& half_axes_m, double roughness, std::uint64_t seed, double albedo = 0.4);

/// Solid steps that climb along +x from the origin, y from 0 to width_m.
Mesh stairs(int steps, double rise_m, double going_m, double width_m, double albedo = 0.5);

/// A door or a window in a wall.
struct Opening {
  double from_m = 0, to_m = 0;     // along the wall
  double bottom_m = 0, top_m = 0;  // above its foot
};

/// A wall along +x with its front at y = 0 and its back at y = thickness_m; openings do not overlap one
/// another along the wall.
Mesh wall(double length_m, double height_m, double thickness_m, std::vector<Opening> openings = {},
          double albedo = 0.6);

}  // namespace sweepscope::simulation
