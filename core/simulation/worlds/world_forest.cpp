#include <cmath>

#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// A trunk with dead branches, and the beginning of a crown on some.
Mesh forest_tree(Draw& draw) {
  const double radius_m = draw.in(0.08, 0.3), height_m = draw.in(7, 15);
  Mesh mesh = frustum(9, 1.2 * radius_m, 0.5 * radius_m, height_m, draw.in(0.3, 0.5));
  for (int branch = draw.count(2, 7); branch > 0; --branch) {
    const double z_m = draw.in(1.8, 0.8 * height_m), rise_m = draw.in(-0.3, 0.8);
    const double long_m = draw.in(0.5, 2.2);
    const SinCos towards = sin_cos(draw.in(0, 2 * kPi));
    mesh.add(rod({0, 0, z_m}, {long_m * towards.cos, long_m * towards.sin, z_m + rise_m}, 0.03, 0.35, 4));
  }
  if (draw.chance(0.35)) {
    const double wide_m = draw.in(1.2, 2.4), high_m = draw.in(1.5, 3);
    mesh.add(boulder({wide_m, wide_m, high_m}, 0.25, draw.seed(), 0.45), {0, 0, 0.75 * height_m, 0});
  }
  Mesh rooted;
  return rooted.add(mesh, {0, 0, -0.4, 0});
}

Mesh undergrowth(Draw& draw) {
  const double kind = draw.in(0, 1);
  if (kind < 0.4) {  // a bush or a rock
    const double wide_m = draw.in(0.3, 0.9), high_m = draw.in(0.3, 1);
    return boulder({wide_m, wide_m, high_m}, 0.25, draw.seed(), kind < 0.2 ? 0.45 : 0.6);
  }
  if (kind < 0.7) return frustum(9, draw.in(0.2, 0.35), 0.2, 0.7, 0.4);  // a stump
  const double radius_m = draw.in(0.1, 0.25), half_m = draw.in(0.8, 2);
  return rod({-half_m, 0, radius_m}, {half_m, 0, radius_m}, radius_m, 0.4, 9);  // a trunk that lies
}

}  // namespace

World forest(Draw& draw) {
  World world;
  const double half_m = draw.in(24, 34), seen_m = half_m + 10;
  world.walked_m = {Vector2d(-half_m, -half_m), Vector2d(half_m, half_m)};
  const Box2 seen(Vector2d(-seen_m, -seen_m), Vector2d(seen_m, seen_m));
  const double hill_m = draw.in(0.3, 2.5);
  const Relief relief(draw, hill_m, draw.in(9, 16));
  world.mesh = relief.mesh(seen, 0.35);
  world.start_m.z() = relief.at(Vector2d::Zero());
  Spots spots(draw.in(1.2, 2));
  spots.take(Vector2d::Zero(), 1.2);
  const double each_m2 = draw.in(10, 26);  // of ground for a tree
  const int trees = static_cast<int>(std::ceil(4 * seen_m * seen_m / each_m2));
  scatter(world.mesh, draw, spots, relief, seen, trees, 0.3, [&] { return forest_tree(draw); });
  const int bushes = draw.count(10, 70);
  scatter(world.mesh, draw, spots, relief, seen, bushes, 0.6, [&] { return undergrowth(draw); });
  return world;
}

}  // namespace sweepscope::simulation
