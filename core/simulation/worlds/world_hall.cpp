#include <algorithm>

#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// Shelves along +x from the origin, of 1.1 m depth about y = 0, with goods on them.
Mesh shelves(Draw& draw, double length_m, double height_m) {
  Mesh mesh;
  const double bay_m = draw.in(1.8, 2.8), level_m = draw.in(0.9, 1.6);
  const int bays = std::max(1, static_cast<int>(length_m / bay_m));
  for (int bay = 0; bay <= bays; ++bay)
    for (const double y : {-0.55, 0.45})
      mesh.add_box({bay * bay_m, y, 0}, {bay * bay_m + 0.09, y + 0.1, height_m}, 0.6);
  for (double z = 0.15; z < height_m; z += level_m) {
    mesh.add_box({0, -0.55, z}, {bays * bay_m, 0.55, z + 0.06}, 0.5);
    for (int bay = 0; bay < bays; ++bay) {
      if (draw.chance(0.25)) continue;
      const double from_m = bay * bay_m + draw.in(0.1, 0.5), to_m = (bay + 1) * bay_m - draw.in(0.05, 0.5);
      const double front_m = draw.in(-0.5, -0.2), top_m = z + 0.06 + draw.in(0.3, 0.8) * level_m;
      mesh.add_box({from_m, front_m, z + 0.06}, {to_m, 0.45, top_m}, draw.in(0.2, 0.9));
    }
  }
  return mesh;
}

/// A machine: a base with a hood, a tank or a mast.
Mesh machine(Draw& draw) {
  const double half_m = draw.in(0.5, 1.2), high_m = draw.in(0.9, 2.2);
  Mesh mesh = box({-half_m, -0.7, 0}, {half_m, 0.7, high_m}, draw.in(0.3, 0.8));
  if (draw.chance(0.5)) mesh.add(prism(12, 0.5, high_m + 1.2, 0.7));
  if (draw.chance(0.5)) mesh.add_box({half_m - 0.4, -0.3, 0}, {half_m + 0.3, 0.3, high_m + 0.5}, 0.5);
  return mesh;
}

void add_roof(Mesh& mesh, Draw& draw, const Vector2d& half, double height_m) {
  mesh.add_box({-half.x(), -half.y(), height_m}, {half.x(), half.y(), height_m + 0.3}, 0.7);
  const double every_m = draw.in(3.5, 7), deep_m = draw.in(0.3, 0.9);
  for (double x = -half.x() + every_m / 2; x < half.x(); x += every_m) {
    mesh.add_box({x - 0.1, -half.y(), height_m - deep_m}, {x + 0.1, half.y(), height_m}, 0.6);
    for (double y = -half.y() + 2; y < half.y() - 2; y += draw.in(5, 9))
      mesh.add_box({x + 1, y, height_m - deep_m - 0.3}, {x + 1.2, y + 1.4, height_m - deep_m - 0.2}, 0.9);
  }
}

/// Columns in a grid and rows of shelves on one part of the floor; machines and crates on the rest.
void fill_hall(World& world, Draw& draw, const Vector2d& half, double height_m) {
  Spots spots(1.7);
  spots.take(Vector2d(world.start_m.x(), world.start_m.y()), 1);
  const double apart_m = draw.in(5.5, 10), thick_m = draw.in(0.15, 0.35);
  const bool round = draw.chance(0.4);
  for (double x = -half.x() + apart_m; x < half.x() - 2; x += apart_m) {
    for (double y = -half.y() + apart_m; y < half.y() - 2; y += apart_m) {
      world.mesh.add(round ? prism(14, thick_m, height_m, 0.6) : prism(4, 1.4 * thick_m, height_m, 0.6),
                     {x, y, 0, 45});
      spots.take({x, y}, thick_m);
    }
  }
  const double shelf_m = draw.in(0.3, 0.7) * half.x(), aisle_m = draw.in(3.2, 4.5);
  const double shelf_height_m = std::min(height_m - 0.5, draw.in(2, 5));
  for (double y = -half.y() + aisle_m; y < half.y() - 2.5; y += aisle_m) {
    if (draw.chance(0.25)) continue;
    const double from_m = draw.in(0.4, 0.8) * -half.x();
    world.mesh.add(shelves(draw, shelf_m, shelf_height_m), {from_m, y, 0, 0});
    for (double x = from_m; x < from_m + shelf_m + 1; x += 1) spots.take({x, y}, 0.6);
  }
  const Box2 within(Vector2d(-half.x() + 2, -half.y() + 2), Vector2d(half.x() - 2, half.y() - 2));
  for (int i = draw.count(4, 16); i > 0; --i) {
    const bool is_machine = draw.chance(0.5);
    const auto spot = spots.find(draw, within, is_machine ? 1.4 : 0.9);
    if (!spot) continue;
    const Placement at{spot->x(), spot->y(), 0, draw.in(0, 360)};
    world.mesh.add(is_machine ? machine(draw) : crates(draw), at);
  }
}

}  // namespace

World hall(Draw& draw) {
  World world;
  const Vector2d half{draw.in(10, 30), draw.in(8, 18)};
  const double height_m = draw.in(4, 9);
  world.walked_m = {-half, half};
  world.start_m = {half.x() - 1.5, draw.in(-0.8, 0.8) * half.y(), 0};
  world.mesh.add_box({-half.x(), -half.y(), -0.3}, {half.x(), half.y(), 0}, 0.4);
  for (const auto& [placement, length_m] : sides_of(world.walked_m))
    world.mesh.add(furnished_wall(draw, length_m, height_m, 0.5), placement);
  add_roof(world.mesh, draw, half, height_m);
  fill_hall(world, draw, half, height_m);
  return world;
}

}  // namespace sweepscope::simulation
