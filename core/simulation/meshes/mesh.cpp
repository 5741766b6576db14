#include "core/simulation/meshes/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

Vector3d on_circle(double radius_m, int corner, int sides, double z_m) {
  const SinCos turn = sin_cos(2 * kPi * corner / sides);
  return {radius_m * turn.cos, radius_m * turn.sin, z_m};
}

/// What lies between two polygons of equally many corners, closed at both ends.
Mesh tube(const std::vector<Vector3d>& begin, const std::vector<Vector3d>& end, double albedo) {
  Mesh mesh;
  mesh.add_polygon(begin, albedo).add_polygon(end, albedo);
  for (std::size_t i = 0, j = begin.size() - 1; i < begin.size(); j = i++)
    mesh.add_polygon(std::array{begin[j], begin[i], end[i], end[j]}, albedo);
  return mesh;
}

/// An icosahedron's faces, once divided into four, on the unit sphere.
struct Sphere {
  std::vector<Vector3d> corners;
  std::vector<std::array<std::size_t, 3>> faces;
};

Sphere icosahedron() {
  const double g = 1.61803398874989484820;
  Sphere s;
  for (const double one : {-1.0, 1.0}) {
    for (const double gold : {-g, g}) {
      s.corners.emplace_back(0, one, gold);
      s.corners.emplace_back(one, gold, 0);
      s.corners.emplace_back(gold, 0, one);
    }
  }
  // Three corners make a face where they are neighbours: 2 apart.
  const auto near = [&](std::size_t i, std::size_t j) { return (s.corners[i] - s.corners[j]).norm() < 2.01; };
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = i + 1; j < 12; ++j)
      for (std::size_t k = j + 1; k < 12; ++k)
        if (near(i, j) && near(j, k) && near(i, k)) s.faces.push_back({i, j, k});
  for (Vector3d& corner : s.corners) corner.normalize();
  return s;
}

Sphere divided(const Sphere& coarse) {
  Sphere fine{coarse.corners, {}};
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
  const auto middle = [&](std::size_t i, std::size_t j) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(i, j), fine.corners.size());
    if (is_new) fine.corners.push_back((coarse.corners[i] + coarse.corners[j]).normalized());
    return at->second;
  };
  for (const auto& [i, j, k] : coarse.faces) {
    const std::size_t ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
    fine.faces.insert(fine.faces.end(), {{i, ij, ki}, {ij, j, jk}, {ki, jk, k}, {ij, jk, ki}});
  }
  return fine;
}

}  // namespace

Mesh& Mesh::add(const Mesh& part, const Placement& placement) {
  const SinCos turn = sin_cos(radians(placement.yaw_deg));
  const auto placed = [&](const Vector3d& p) {
    return Vector3d(placement.x_m + turn.cos * p.x() - turn.sin * p.y(),
                    placement.y_m + turn.sin * p.x() + turn.cos * p.y(), placement.z_m + p.z());
  };
  triangles.reserve(triangles.size() + part.triangles.size());
  for (const Triangle& t : part.triangles)
    triangles.push_back({placed(t.a), placed(t.b), placed(t.c), t.albedo});
  return *this;
}

Mesh& Mesh::add_polygon(std::span<const Vector3d> corners, double albedo) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    triangles.push_back({corners[0], corners[i - 1], corners[i], albedo});
  return *this;
}

Mesh& Mesh::add_box(const Vector3d& low, const Vector3d& high, double albedo) {
  std::array<Vector3d, 8> p;
  for (std::size_t i = 0; i < 8; ++i)
    p[i] = {(i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(), (i & 4) ? high.z() : low.z()};
  constexpr std::size_t kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) add_polygon(std::array{p[f[0]], p[f[1]], p[f[2]], p[f[3]]}, albedo);
  return *this;
}

Mesh box(const Vector3d& low, const Vector3d& high, double albedo) {
  return Mesh{}.add_box(low, high, albedo);
}

Mesh frustum(int sides, double bottom_m, double top_m, double height_m, double albedo) {
  std::vector<Vector3d> below, above;
  for (int i = 0; i < sides; ++i) {
    below.push_back(on_circle(bottom_m, i, sides, 0));
    above.push_back(on_circle(top_m, i, sides, height_m));
  }
  return tube(below, above, albedo);
}

Mesh prism(int sides, double radius_m, double height_m, double albedo) {
  return frustum(sides, radius_m, radius_m, height_m, albedo);
}

Mesh rod(const Vector3d& from, const Vector3d& to, double radius_m, double albedo, int sides) {
  const Vector3d along = (to - from).normalized();
  const Vector3d side =
      along.cross(std::abs(along.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX()).normalized();
  const Vector3d up = along.cross(side);
  std::vector<Vector3d> begin, end;
  for (int i = 0; i < sides; ++i) {
    const Vector3d on_rim = on_circle(radius_m, i, sides, 0);
    begin.emplace_back(from + on_rim.x() * side + on_rim.y() * up);
    end.emplace_back(to + on_rim.x() * side + on_rim.y() * up);
  }
  return tube(begin, end, albedo);
}

Mesh extrusion(std::span<const Vector2d> profile_xz, double depth_m, double albedo) {
  std::vector<Vector3d> front, back;
  for (const Vector2d& p : profile_xz) {
    front.emplace_back(p.x(), 0, p.y());
    back.emplace_back(p.x(), depth_m, p.y());
  }
  return tube(front, back, albedo);
}

Mesh boulder(const Vector3d& half_axes_m, double roughness, std::uint64_t seed, double albedo) {
  const Sphere sphere = divided(divided(icosahedron()));
  Random random(seed, 0, 0);
  std::vector<Vector3d> corners;
  for (const Vector3d& corner : sphere.corners)
    corners.push_back(corner.cwiseProduct(half_axes_m) * (1 + roughness * (2 * random.uniform() - 1)));
  Mesh mesh;
  for (const auto& [i, j, k] : sphere.faces)
    mesh.triangles.push_back({corners[i], corners[j], corners[k], albedo});
  return mesh;
}

Mesh stairs(int steps, double rise_m, double going_m, double width_m, double albedo) {
  Mesh mesh;
  for (int i = 0; i < steps; ++i)
    mesh.add_box({i * going_m, 0, i * rise_m}, {steps * going_m, width_m, (i + 1) * rise_m}, albedo);
  return mesh;
}

Mesh wall(double length_m, double height_m, double thickness_m, std::vector<Opening> openings,
          double albedo) {
  std::sort(openings.begin(), openings.end(),
            [](const Opening& l, const Opening& r) { return l.from_m < r.from_m; });
  Mesh mesh;
  const auto piece = [&](double from_m, double to_m, double bottom_m, double top_m) {
    if (to_m > from_m && top_m > bottom_m)
      mesh.add_box({from_m, 0, bottom_m}, {to_m, thickness_m, top_m}, albedo);
  };
  double done_m = 0;
  for (const Opening& opening : openings) {
    piece(done_m, opening.from_m, 0, height_m);
    piece(opening.from_m, opening.to_m, 0, opening.bottom_m);
    piece(opening.from_m, opening.to_m, opening.top_m, height_m);
    done_m = opening.to_m;
  }
  piece(done_m, length_m, 0, height_m);
  return mesh;
}

}  // namespace sweepscope::simulation
