#include "core/simulation/worlds/clutter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/simulation/scenes/parts.hpp"

namespace sweepscope::simulation {

std::optional<Vector2d> Spots::find(Draw& draw, const Box2& within_m, double radius_m) {
  for (int i = 0; i < 40; ++i) {
    const Vector2d at{draw.in(within_m.min().x(), within_m.max().x()),
                      draw.in(within_m.min().y(), within_m.max().y())};
    const bool is_free = std::ranges::all_of(taken_, [&](const auto& other) {
      return (other.first - at).norm() >= other.second + radius_m + gap_m_;
    });
    if (!is_free) continue;
    take(at, radius_m);
    return at;
  }
  return std::nullopt;
}

Relief::Relief(Draw& draw, double height_m, double wave_m) {
  constexpr int kWaves = 7;
  for (int i = 0; i < kWaves; ++i) {
    const SinCos towards = sin_cos(draw.in(0, 2 * kPi));
    const double per_m = 2 * kPi / (wave_m * draw.in(1, 3));
    waves_.push_back({per_m * Vector2d(towards.cos, towards.sin), draw.in(0, 2 * kPi), height_m / kWaves});
  }
}

double Relief::at(const Vector2d& p_m) const {
  double z_m = 0;
  for (const Wave& wave : waves_) z_m += wave.height_m * sin_cos(wave.per_m.dot(p_m) + wave.phase_rad).sin;
  return z_m;
}

Mesh Relief::mesh(const Box2& box_m, double albedo) const {
  const Vector2d size = box_m.sizes();
  const int columns = static_cast<int>(std::ceil(size.x())), rows = static_cast<int>(std::ceil(size.y()));
  const auto corner = [&](int i, int j) {
    const Vector2d p = box_m.min() + Vector2d(size.x() * i / columns, size.y() * j / rows);
    return Vector3d(p.x(), p.y(), at(p));
  };
  Mesh mesh;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      mesh.add_polygon(std::array{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)}, albedo);
      mesh.add_polygon(std::array{corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)}, albedo);
    }
  }
  return mesh;
}

void scatter(Mesh& mesh, Draw& draw, Spots& spots, const Relief& relief, const Box2& within_m, int count,
             double radius_m, const std::function<Mesh()>& make) {
  for (; count > 0; --count) {
    const auto spot = spots.find(draw, within_m, radius_m);
    if (!spot) continue;
    const double yaw_deg = draw.in(0, 360);
    mesh.add(make(), {spot->x(), spot->y(), relief.at(*spot), yaw_deg});
  }
}

std::vector<std::pair<Placement, double>> sides_of(const Box2& box_m) {
  const Vector2d low = box_m.min(), high = box_m.max(), size = box_m.sizes();
  return {{{low.x(), high.y(), 0, 0}, size.x()},
          {{high.x(), high.y(), 0, -90}, size.y()},
          {{high.x(), low.y(), 0, 180}, size.x()},
          {{low.x(), low.y(), 0, 90}, size.y()}};
}

Mesh furnished_wall(Draw& draw, double length_m, double height_m, double depth_m) {
  constexpr double kThick_m = 0.3;
  Mesh mesh;
  std::vector<Opening> openings;
  for (double x = draw.in(0.3, 2.5); x + 1.4 < length_m; x += 1.2 + draw.in(0.2, 3.2)) {
    const double top_m = std::min(2.1, height_m - 0.2), kind = draw.in(0, 1), albedo = draw.in(0.2, 0.9);
    const double width_m = draw.in(0.5, 1.2), out_m = std::min(depth_m, draw.in(0.08, 0.45));
    if (kind < 0.35) {  // a door in its frame
      const double recess_m = draw.in(0.06, 0.2);
      openings.push_back({x, x + 0.95, 0, top_m});
      mesh.add_box({x, recess_m, 0}, {x + 0.95, recess_m + 0.05, top_m}, albedo);
      mesh.add_box({x + 0.08, recess_m - 0.05, 1.0}, {x + 0.2, recess_m, 1.04}, 0.8);
    } else if (kind < 0.5) {  // a niche
      const double from_m = draw.in(0, 1);
      openings.push_back({x, x + 1.2, from_m, top_m});
      mesh.add_box({x, kThick_m - 0.02, from_m}, {x + 1.2, kThick_m, top_m}, albedo);
    } else if (kind < 0.65) {  // a board
      const double from_m = draw.in(0.7, 1.3);
      mesh.add_box({x, -0.05, from_m}, {x + width_m, 0, from_m + 0.8}, albedo);
    } else if (kind < 0.8) {  // a pilaster
      mesh.add_box({x, -out_m, 0}, {x + width_m / 2, 0, height_m}, albedo);
    } else if (kind < 0.9) {  // a radiator
      mesh.add_box({x, -std::min(depth_m, 0.13), 0.15}, {x + 1.1, 0, 0.8}, 0.9);
    } else {  // a cabinet
      mesh.add_box({x, -out_m, 0}, {x + width_m, 0, std::min(height_m, draw.in(0.9, 2.0))}, albedo);
    }
  }
  return mesh.add(wall(length_m, height_m, kThick_m, openings, draw.in(0.5, 0.8)));
}

Mesh shed(Draw& draw) {
  const double x_m = draw.in(1.0, 3.0), y_m = draw.in(1.0, 2.2), z_m = draw.in(2.1, 3.0);
  Mesh mesh = box({-x_m, -y_m, -1}, {x_m, y_m, z_m}, draw.in(0.3, 0.7));
  const double eave_m = draw.in(0.1, 0.4), ridge_m = z_m + draw.in(0.4, 1.2);
  const std::array<Vector2d, 3> gable = {Vector2d(-x_m - eave_m, z_m), Vector2d(x_m + eave_m, z_m),
                                         Vector2d(0, ridge_m)};
  mesh.add(extrusion(gable, 2 * (y_m + eave_m), 0.4), {0, -y_m - eave_m, 0, 0});
  mesh.add_box({-0.5, -y_m - 0.05, 0}, {0.5, -y_m, 2.0}, 0.6);
  return mesh.add_box({x_m, -0.4, 1.0}, {x_m + 0.06, 0.4, 1.7}, 0.8);
}

Mesh crates(Draw& draw) {
  Mesh mesh;
  const int stacks = draw.count(1, 2);
  for (int i = 0; i < stacks; ++i) {
    const Placement at{draw.in(-0.3, 0.3), 0.6 * i - 0.3, 0, draw.in(0, 90)};
    double z_m = -0.5;
    for (int level = draw.count(1, 3); level > 0; --level) {
      const double half_m = draw.in(0.25, 0.42), high_m = z_m + (z_m < 0 ? 0.5 : 0) + draw.in(0.4, 0.9);
      mesh.add(box({-half_m, -0.8 * half_m, z_m}, {half_m, 0.8 * half_m, high_m}, draw.in(0.2, 0.9)), at);
      z_m = high_m;
    }
  }
  return mesh;
}

Mesh pole(Draw& draw) {
  const double kind = draw.in(0, 1), height_m = draw.in(2.2, 6);
  const double thick = draw.in(1, 2);
  if (kind < 0.35) return lamp_post(height_m + 1);
  if (kind < 0.65) return prism(8, 0.06 * thick, height_m, 0.6);
  if (kind < 0.8) {
    Mesh sign = prism(6, 0.035, 2.6, 0.6);
    return sign.add_box({-0.35, -0.02, 1.9}, {0.35, 0.02, 2.6}, 0.9);
  }
  return prism(10, (kind < 0.9 ? 0.08 : 0.18) * thick, height_m / 5 + 0.4, 0.5);
}

Mesh any_tree(Draw& draw, double max_height_m) {
  const double height_m = draw.in(0.5, 1) * max_height_m, crown_m = draw.in(1.4, 2.8);
  const std::uint64_t seed = draw.seed();
  return draw.chance(0.6) ? tree(height_m, crown_m, seed) : bare_tree(height_m, seed);
}

}  // namespace sweepscope::simulation
