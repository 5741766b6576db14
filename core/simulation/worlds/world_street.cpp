#include <algorithm>

#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// The buildings of one side from x = 0 to length_m, seen from y < 0: fronts of different kinds and setbacks,
/// and gaps closed by a fence further back.
Mesh row_of_buildings(Draw& draw, double length_m) {
  Mesh mesh;
  for (double x = 0; x < length_m;) {
    const double long_m = draw.in(8, 24), back_m = draw.in(0, 1.2);
    if (draw.chance(0.2)) {
      const double gap_m = draw.in(2.5, 6);
      mesh.add(wall(gap_m, draw.in(1.6, 2.4), 0.1), {x, 4, 0, 0});
      x += gap_m;
      continue;
    }
    FacadeSpec front{.length_m = long_m};
    front.floors = draw.count(2, 4);
    front.bays = std::max(2, static_cast<int>(long_m / draw.in(2.5, 4)));
    front.floor_m = draw.in(2.9, 3.8);
    front.door_bay = draw.count(0, front.bays - 1);
    mesh.add(facade(front), {x, back_m, 0, 0});
    mesh.add_box({x, back_m + 0.2, 0}, {x + long_m, back_m + 5, front.floors * front.floor_m}, 0.5);
    x += long_m;
  }
  return mesh;
}

/// Parked cars along the kerb, and trees, lamps, benches and crates on the pavement, along +x.
Mesh kerbside(Draw& draw, double length_m, double pavement_m) {
  Mesh mesh;
  const double parked = draw.in(0.2, 0.9);
  for (double x = draw.in(2, 5); x < length_m - 3; x += draw.in(5.2, 7)) {
    if (!draw.chance(parked)) continue;
    const bool tall = draw.chance(0.2);
    const double albedo = draw.in(0.25, 0.95), askew_deg = draw.in(-3, 3);
    mesh.add(car(tall, albedo), {x, -pavement_m - 1.2, 0, (draw.chance(0.5) ? 0 : 180) + askew_deg});
  }
  for (double x = draw.in(2, 7); x < length_m; x += draw.in(5, 14)) {
    const double kind = draw.in(0, 1), yaw_deg = draw.in(0, 360);
    const Placement at{x, -pavement_m + 0.45, 0.12, yaw_deg};
    if (kind < 0.35)
      mesh.add(any_tree(draw, 8), at);
    else if (kind < 0.8)
      mesh.add(pole(draw), at);
    else
      mesh.add(crates(draw), at);
  }
  return mesh;
}

}  // namespace

World street(Draw& draw) {
  World world;
  const double half_m = draw.in(32, 75), wide_m = draw.in(6, 9), pavement_m = draw.in(1.9, 3.2);
  world.walked_m = {Vector2d(-half_m, -wide_m), Vector2d(half_m, wide_m)};
  world.mesh.add_box({-half_m - 40, -60, -0.3}, {half_m + 40, 60, 0}, 0.25);
  for (const double yaw_deg : {0.0, 180.0}) {
    Mesh side = row_of_buildings(draw, 2 * half_m);
    side.add(kerbside(draw, 2 * half_m, pavement_m));
    side.add_box({0, -pavement_m, 0}, {2 * half_m, 8, 0.12}, 0.4);
    const double sign = yaw_deg == 0 ? 1 : -1;
    world.mesh.add(side, {-sign * half_m, sign * wide_m, 0, yaw_deg});
  }
  // Streets that cross at the ends, with buildings behind them or none.
  for (const double sign : {-1.0, 1.0}) {
    if (draw.chance(0.3)) continue;
    const double far_m = half_m + draw.in(8, 14);
    world.mesh.add(row_of_buildings(draw, 50), {sign * far_m, sign * 25, 0, -sign * 90});
  }
  world.start_m.x() = draw.in(-0.9, 0.9) * half_m;
  return world;
}

}  // namespace sweepscope::simulation
