#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// Two flights to a storey, side by side along x; a lobby at x < 0 on every storey, half landings at the far
/// end. y from 0 to width_m().
struct Stairwell {
  int storeys, steps;  // of a flight
  double rise_m, going_m, flight_m, gap_m, lobby_m, landing_m;

  double run_m() const { return steps * going_m; }
  double half_storey_m() const { return steps * rise_m; }
  double width_m() const { return 2 * flight_m + gap_m; }
};

/// A flight that climbs along +x, y from 0 to its width, with a handrail at the side of y = rail_m.
Mesh thin_flight(const Stairwell& s, double rail_m) {
  constexpr double kThick_m = 0.22;
  Mesh mesh;
  for (int i = 0; i < s.steps; ++i)
    mesh.add_box({i * s.going_m, 0, i * s.rise_m - kThick_m},
                 {(i + 1) * s.going_m + 0.02, s.flight_m, (i + 1) * s.rise_m}, 0.5);
  const Vector3d foot(0, rail_m, 0.95), head(s.run_m(), rail_m, s.half_storey_m() + 0.95);
  mesh.add(rod(foot, head, 0.025, 0.6));
  for (int i = 0; i < s.steps; i += 2) {
    const Vector3d post((i + 0.5) * s.going_m, rail_m, (i + 0.5) * s.rise_m);
    mesh.add(rod(post, post + 0.95 * Vector3d::UnitZ(), 0.015, 0.6, 5));
  }
  return mesh;
}

void add_storey(Mesh& mesh, const Stairwell& s, int storey) {
  const double z = 2 * s.half_storey_m() * storey, half_z = z + s.half_storey_m(), width_m = s.width_m();
  mesh.add_box({-s.lobby_m, 0, z - 0.22}, {0, width_m, z}, 0.5);
  if (storey == s.storeys) {  // the well is fenced off where no flight goes on
    for (const double up_m : {0.5, 0.95})
      mesh.add(rod({0, 0, z + up_m}, {0, s.flight_m + s.gap_m, z + up_m}, 0.025, 0.6));
    return;
  }
  mesh.add_box({s.run_m(), 0, half_z - 0.22}, {s.run_m() + s.landing_m, width_m, half_z}, 0.5);
  mesh.add(thin_flight(s, s.flight_m - 0.05), {0, 0, z, 0});
  mesh.add(thin_flight(s, s.flight_m - 0.05), {s.run_m(), width_m, half_z, 180});
}

/// Around the whole well, a storey at a time, with windows at the half landings.
void add_shell(Mesh& mesh, Draw& draw, const Stairwell& s) {
  const Box2 plan(Vector2d(-s.lobby_m, 0), Vector2d(s.run_m() + s.landing_m, s.width_m()));
  const double storey_m = 2 * s.half_storey_m();
  for (int storey = 0; storey <= s.storeys; ++storey) {
    for (auto [placement, length_m] : sides_of(plan)) {
      placement.z_m = storey * storey_m;
      if (placement.yaw_deg == 90) {  // the lobby's doors
        mesh.add(furnished_wall(draw, length_m, storey_m, 0.15), placement);
        continue;
      }
      std::vector<Opening> windows;
      if (placement.yaw_deg == -90) {
        const double from_m = draw.in(0.3, 0.9), wide_m = draw.in(0.8, 1.6),
                     sill_m = 0.5 * storey_m + draw.in(0.6, 1);
        windows.push_back({from_m, from_m + wide_m, sill_m, storey_m - 0.1});
        mesh.add(box({from_m, 0.2, 0}, {from_m + wide_m, 0.25, storey_m}, 0.6), placement);
      }
      mesh.add(wall(length_m, storey_m, 0.3, windows), placement);
      for (double x = draw.in(1, 3); x + 1 < length_m; x += draw.in(1.5, 4)) {
        const double z = draw.in(0.8, storey_m - 0.8), size_m = draw.in(0.2, 0.7);
        mesh.add(box({x, -0.06, z}, {x + size_m, 0, z + 0.6}, draw.in(0.3, 0.9)), placement);
      }
    }
  }
  const double top_m = (s.storeys + 1) * storey_m;
  mesh.add_box({plan.min().x(), 0, top_m}, {plan.max().x(), s.width_m(), top_m + 0.3}, 0.8);
}

}  // namespace

World stairwell(Draw& draw) {
  World world;
  const Stairwell s{.storeys = draw.count(2, 5),
                    .steps = draw.count(9, 11),
                    .rise_m = draw.in(0.155, 0.18),
                    .going_m = draw.in(0.27, 0.31),
                    .flight_m = draw.in(1.5, 2.2),
                    .gap_m = draw.in(0.1, 0.9),
                    .lobby_m = draw.in(2.5, 7),
                    .landing_m = draw.in(1.7, 2.5)};
  for (int storey = 0; storey <= s.storeys; ++storey) add_storey(world.mesh, s, storey);
  world.mesh.add_box({0, 0, -0.22}, {s.run_m() + s.landing_m, s.width_m(), 0}, 0.5);
  add_shell(world.mesh, draw, s);
  world.walked_m = {Vector2d(-s.lobby_m, 0), Vector2d(s.run_m() + s.landing_m, s.width_m())};
  world.start_m = {-s.lobby_m / 2, s.width_m() / 2, 0};
  return world;
}

}  // namespace sweepscope::simulation
