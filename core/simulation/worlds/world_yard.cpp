#include <algorithm>

#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// One side of a yard: a building's front, or a wall, with or without piers.
Mesh yard_side(Draw& draw, double length_m) {
  if (draw.chance(0.4)) {
    FacadeSpec front{.length_m = length_m};
    front.floors = draw.count(1, 3);
    front.bays = std::max(2, static_cast<int>(length_m / draw.in(2.6, 4.5)));
    front.floor_m = draw.in(2.8, 3.6);
    front.door_bay = draw.count(0, front.bays - 1);
    return facade(front);
  }
  const double height_m = draw.in(1.7, 3.2);
  Mesh mesh = wall(length_m, height_m + 1, 0.3);
  if (draw.chance(0.6))
    for (double x = draw.in(0.5, 3); x + 0.5 < length_m; x += draw.in(3, 5))
      mesh.add_box({x, -0.2, 0}, {x + 0.45, 0.3, height_m + 1.3}, 0.5);
  Mesh sunk;
  return sunk.add(mesh, {0, 0, -1, 0});
}

/// Sheds, crates, poles, trees and benches; none in the middle, where walks begin.
void fill_yard(World& world, Draw& draw, const Relief& relief) {
  Spots spots(1.6);
  spots.take(Vector2d::Zero(), 1.0);
  const Vector2d inset = Vector2d::Constant(1.4);
  const Box2 within(world.walked_m.min() + inset, world.walked_m.max() - inset);
  const auto put = [&](int count, double radius_m, const std::function<Mesh()>& make) {
    scatter(world.mesh, draw, spots, relief, within, count, radius_m, make);
  };
  put(draw.count(1, 3), 3.2, [&] { return shed(draw); });
  put(draw.count(0, 2), 2.4, [&] {
    const bool tall = draw.chance(0.3);
    return car(tall, draw.in(0.3, 0.9));
  });
  put(draw.count(3, 10), 0.9, [&] { return crates(draw); });
  put(draw.count(3, 9), 0.4, [&] { return pole(draw); });
  put(draw.count(0, 6), 0.5, [&] { return any_tree(draw, 8); });
  put(draw.count(0, 3), 1.8, [&] { return garden_bench(); });
}

}  // namespace

World yard(Draw& draw) {
  World world;
  const Vector2d half{draw.in(11, 26), draw.in(10, 20)};
  world.walked_m = {-half, half};
  const Relief relief(draw, draw.in(0, 0.25), 8);
  world.mesh = relief.mesh({-half - Vector2d(2, 2), half + Vector2d(2, 2)}, 0.3);
  world.start_m.z() = relief.at(Vector2d::Zero());
  for (auto [placement, length_m] : sides_of(world.walked_m)) {
    placement.z_m = -0.3;  // below the lowest ground
    world.mesh.add(yard_side(draw, length_m), placement);
  }
  fill_yard(world, draw, relief);
  return world;
}

}  // namespace sweepscope::simulation
