#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// A winding axis in plan along x, and the arch about it.
class Bore {
 public:
  explicit Bore(Draw& draw)
      : length_m(draw.in(60, 140)),
        half_m(draw.in(1.6, 3.2)),
        wall_m(draw.in(1.4, 2.2)),
        crown_m(wall_m + half_m * draw.in(0.6, 1)),
        rough_m(draw.chance(0.5) ? 0 : draw.in(0.03, 0.15)),
        seed_(draw.seed()) {
    for (Wave& wave : waves_) wave = {2 * kPi / draw.in(50, 120), draw.in(0, 2 * kPi), draw.in(0, 3)};
  }

  Vector2d axis_m(double s_m) const {
    double y = 0;
    for (const Wave& wave : waves_) y += wave.size_m * sin_cos(wave.per_m * s_m + wave.phase_rad).sin;
    return {s_m, y};
  }
  /// left_m to the left of the axis at a height.
  Vector3d at(double s_m, double left_m, double z_m) const {
    const Vector2d before = axis_m(s_m - 0.5), along = (axis_m(s_m + 0.5) - before).normalized();
    const Vector2d p = axis_m(s_m) + left_m * Vector2d(-along.y(), along.x());
    return {p.x(), p.y(), z_m};
  }
  /// A corner of the lining, from the right foot over the crown to the left foot; `in_m` further inside.
  Vector3d lining(double s_m, int corner, double in_m) const {
    const auto number =
        static_cast<std::uint64_t>(std::floor(s_m + 0.5)) * kCorners + static_cast<std::uint64_t>(corner);
    const double rough = rough_m * (2 * Random(seed_, 0, number).uniform() - 1);
    const double side_m = half_m - in_m + rough;
    if (corner == 0 || corner + 1 == kCorners) return at(s_m, corner == 0 ? -side_m : side_m, 0);
    const SinCos turn = sin_cos(kPi * (corner - 1) / (kCorners - 3));
    return at(s_m, -side_m * turn.cos, wall_m + (crown_m - wall_m - in_m + rough) * turn.sin);
  }

  static constexpr int kCorners = 13;
  const double length_m, half_m, wall_m, crown_m, rough_m;

 private:
  struct Wave {
    double per_m, phase_rad, size_m;
  };
  std::array<Wave, 2> waves_{};
  std::uint64_t seed_;
};

void add_quad(Mesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
              double albedo) {
  mesh.add_polygon(std::array{a, b, c}, albedo).add_polygon(std::array{a, c, d}, albedo);
}

/// The lining of one metre; in place of a wall's quad there may be a niche 0.7 m deep.
void add_metre(Mesh& mesh, const Bore& bore, double s_m, bool right_niche, bool left_niche) {
  const double next_m = s_m + 1;
  add_quad(mesh, bore.at(s_m, -bore.half_m - 1, 0), bore.at(next_m, -bore.half_m - 1, 0),
           bore.at(next_m, bore.half_m + 1, 0), bore.at(s_m, bore.half_m + 1, 0), 0.35);
  for (int i = 0; i + 1 < Bore::kCorners; ++i) {
    const Vector3d a = bore.lining(s_m, i, 0), b = bore.lining(next_m, i, 0);
    const Vector3d c = bore.lining(next_m, i + 1, 0), d = bore.lining(s_m, i + 1, 0);
    if (!(i == 0 && right_niche) && !(i + 2 == Bore::kCorners && left_niche)) {
      add_quad(mesh, a, b, c, d, 0.5);
      continue;
    }
    const Vector3d out = 0.7 * (bore.at(s_m, i == 0 ? -1 : 1, 0) - bore.at(s_m, 0, 0));
    add_quad(mesh, a + out, b + out, c + out, d + out, 0.45);
    add_quad(mesh, a, a + out, d + out, d, 0.5);
    add_quad(mesh, b, b + out, c + out, c, 0.5);
    add_quad(mesh, i == 0 ? c : a, i == 0 ? d : b, (i == 0 ? d : b) + out, (i == 0 ? c : a) + out, 0.5);
  }
}

/// A rib of the lining: a band that stands out.
void add_rib(Mesh& mesh, const Bore& bore, double s_m, double wide_m, double out_m) {
  for (int i = 0; i + 1 < Bore::kCorners; ++i) {
    const auto corner = [&](double along_m, int j, double in_m) {
      return bore.lining(s_m + along_m, j, in_m);
    };
    add_quad(mesh, corner(0, i, out_m), corner(wide_m, i, out_m), corner(wide_m, i + 1, out_m),
             corner(0, i + 1, out_m), 0.6);
    for (const double along_m : {0.0, wide_m})
      add_quad(mesh, corner(along_m, i, -0.2), corner(along_m, i, out_m), corner(along_m, i + 1, out_m),
               corner(along_m, i + 1, -0.2), 0.6);
  }
}

/// Pipes along one wall, lamps, cabinets, and rubble at the feet of the walls.
void equip(Mesh& mesh, Draw& draw, const Bore& bore) {
  for (int pipe = draw.count(0, 3); pipe > 0; --pipe) {
    const double side = draw.chance(0.5) ? 1 : -1, radius_m = draw.in(0.03, 0.12);
    const double left_m = side * (bore.half_m - 0.2), z_m = draw.in(0.5, bore.wall_m);
    for (double s = 0; s < bore.length_m; s += 2)
      mesh.add(rod(bore.at(s, left_m, z_m), bore.at(s + 2, left_m, z_m), radius_m, 0.7, 8));
  }
  for (double s = draw.in(0, 6); s < bore.length_m; s += draw.in(4, 14)) {
    const double side = draw.chance(0.5) ? 1 : -1, kind = draw.in(0, 1), size_m = draw.in(0.2, 0.4);
    const Vector3d p = bore.at(s, side * (bore.half_m - 0.15), 0);
    const Placement at{p.x(), p.y(), 0, draw.in(-5, 5)};
    if (kind < 0.4)
      mesh.add(box({-0.4, -size_m, 0}, {0.5, size_m, 1 + size_m}, 0.7), at);
    else if (kind < 0.7)
      mesh.add(boulder({size_m, size_m, size_m}, 0.3, draw.seed(), 0.5), at);
    else
      mesh.add(box({-0.6, -0.1, 0}, {0.6, 0.1, 0.12}, 0.95),
               {p.x(), bore.axis_m(s).y(), bore.crown_m - 0.25, 0});
  }
}

}  // namespace

World tunnel(Draw& draw) {
  World world;
  const Bore bore(draw);
  const double niches = draw.in(0.03, 0.15);
  for (double s = 0; s < bore.length_m; s += 1) {
    const bool right = draw.chance(niches), left = draw.chance(niches);
    add_metre(world.mesh, bore, s, right, left);
  }
  const double apart_m = draw.in(2, 7), out_m = draw.in(0.1, 0.3), wide_m = draw.in(0.25, 0.6);
  for (double s = draw.in(0, apart_m); s + 1 < bore.length_m; s += apart_m * draw.in(0.6, 1.4))
    add_rib(world.mesh, bore, s, wide_m, out_m);
  equip(world.mesh, draw, bore);
  for (const double s : {0.0, std::ceil(bore.length_m)}) {
    if (draw.chance(0.4)) continue;
    const Vector3d p = bore.at(s, 0, 0);
    world.mesh.add_box({p.x() - 0.2, p.y() - 6, 0}, {p.x() + 0.2, p.y() + 6, bore.crown_m + 1}, 0.5);
  }
  const double reach_m = bore.half_m + 8;
  world.walked_m = {Vector2d(1, -reach_m), Vector2d(bore.length_m - 1, reach_m)};
  world.start_m = bore.at(draw.in(0.1, 0.9) * bore.length_m, 0, 0);
  return world;
}

}  // namespace sweepscope::simulation
