#include <array>

#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/worlds/clutter.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope::simulation {
namespace {

/// Two decks one above the other, x from 0 to length_m, y from 0 to lanes * kLane_m, and a ramp beside them
/// at greater y.
struct Decks {
  static constexpr double kLane_m = 16, kRamp_m = 5.5, kSlab_m = 0.35, kLevel_m = 6;
  double length_m, height_m;  // from floor to floor
  int lanes;
  double pillars_m;  // apart
  bool roofed;

  double depth_m() const { return lanes * kLane_m; }
  double ramp_end_m() const { return kLevel_m + height_m / 0.14; }
};

void add_cars(Mesh& mesh, Draw& draw, const Decks& decks, double z_m) {
  const double parked = draw.in(0.15, 0.8);
  for (int lane = 0; lane < decks.lanes; ++lane) {
    for (const double across_m : {2.5, 13.5}) {
      for (double x = 2.2; x + 1.5 < decks.length_m; x += 2.6) {
        if (!draw.chance(parked)) continue;
        const bool at_ramp = lane + 1 == decks.lanes && across_m > 8;
        if (at_ramp && (x < Decks::kLevel_m + 1 || x > decks.ramp_end_m() - 1)) continue;
        const bool tall = draw.chance(0.15);
        const double albedo = draw.in(0.25, 0.95), askew_deg = draw.in(-3, 3);
        const double off_m = draw.in(-0.2, 0.3);
        mesh.add(car(tall, albedo), {x, lane * Decks::kLane_m + across_m + off_m, z_m,
                                     (draw.chance(0.5) ? 90 : -90) + askew_deg});
      }
    }
  }
}

/// Pillars and beams of one level, and pipes and lamps below its ceiling.
void add_level(Mesh& mesh, Draw& draw, const Decks& decks, double z_m) {
  const double clear_m = decks.height_m - Decks::kSlab_m, thick_m = draw.in(0.2, 0.35);
  for (int row = 0; row <= 2 * decks.lanes; ++row) {
    const double y = row % 2 == 0 ? row * 8.0 : (row / 2) * 16 + 4.9;
    for (double x = decks.pillars_m / 2; x < decks.length_m; x += decks.pillars_m)
      mesh.add_box({x - thick_m, y - thick_m, z_m}, {x + thick_m, y + thick_m, z_m + clear_m}, 0.7);
  }
  for (double x = decks.pillars_m / 2; x < decks.length_m; x += decks.pillars_m)
    mesh.add_box({x - 0.15, 0, z_m + clear_m - 0.22}, {x + 0.15, decks.depth_m(), z_m + clear_m}, 0.7);
  for (int pipe = draw.count(1, 3); pipe > 0; --pipe) {
    const double y = draw.in(1, decks.depth_m() - 1), radius_m = draw.in(0.04, 0.1);
    const Vector3d from(0, y, z_m + clear_m - 0.12), to(decks.length_m, y, z_m + clear_m - 0.12);
    mesh.add(rod(from, to, radius_m, 0.7, 8));
  }
}

/// The ramp's slab, level before and behind its slope, and the parapets at its sides.
void add_ramp(Mesh& mesh, const Decks& decks) {
  const double y0 = decks.depth_m(), y1 = y0 + Decks::kRamp_m, from_m = Decks::kLevel_m,
               to_m = decks.ramp_end_m();
  const auto slope = [&](double y, double thick_m, double above_m) {
    const std::array<Vector2d, 4> profile = {
        Vector2d(from_m, above_m - 0.01 - thick_m), Vector2d(to_m, decks.height_m + above_m - thick_m),
        Vector2d(to_m, decks.height_m + above_m), Vector2d(from_m, above_m)};
    return std::pair(profile, y);
  };
  const auto [floor, floor_y] = slope(y0, 0.3, 0);
  mesh.add(extrusion(floor, Decks::kRamp_m, 0.4), {0, floor_y, 0, 0});
  for (const double y : {y0 - 0.1, y1 - 0.1}) {
    const auto [parapet, parapet_y] = slope(y, 1.4, 1.0);
    mesh.add(extrusion(parapet, 0.2, 0.6), {0, parapet_y, 0, 0});
  }
  mesh.add_box({to_m, y0, decks.height_m - Decks::kSlab_m}, {decks.length_m, y1, decks.height_m}, 0.4);
}

/// Parapets around a level but for the opening to the ramp from open_from_m to open_to_m.
void add_parapets(Mesh& mesh, Draw& draw, const Decks& decks, double z_m, double open_from_m,
                  double open_to_m) {
  const double high_m = draw.in(0.9, 1.2), long_m = decks.length_m;
  const Box2 plan(Vector2d::Zero(), Vector2d(long_m, decks.depth_m() + Decks::kRamp_m));
  for (const auto& [placement, length_m] : sides_of(plan))
    mesh.add(box({0, 0, z_m}, {length_m, 0.2, z_m + high_m}, 0.6), placement);
  const double y = decks.depth_m();
  mesh.add_box({0, y - 0.1, z_m}, {open_from_m, y + 0.1, z_m + high_m}, 0.6);
  mesh.add_box({open_to_m, y - 0.1, z_m}, {long_m, y + 0.1, z_m + high_m}, 0.6);
}

/// Fronts of houses on some sides, a stair tower, and lamps on an open roof.
void add_neighbours(Mesh& mesh, Draw& draw, const Decks& decks) {
  const double far_m = draw.in(7, 14);
  const Box2 around(Vector2d(-far_m, -far_m), Vector2d(decks.length_m + far_m, decks.depth_m() + far_m + 5));
  mesh.add_box({-40, -40, -0.5}, {decks.length_m + 40, decks.depth_m() + 40, 0}, 0.3);
  for (const auto& [placement, length_m] : sides_of(around)) {
    if (draw.chance(0.3)) continue;
    FacadeSpec front{.length_m = length_m, .floors = draw.count(2, 4)};
    front.bays = static_cast<int>(length_m / draw.in(2.6, 4.5));
    mesh.add(facade(front), placement);
  }
  mesh.add_box({decks.length_m - 3.2, decks.depth_m() - 3, 0},
               {decks.length_m - 0.2, decks.depth_m() - 0.2, 2 * decks.height_m}, 0.6);
  if (!decks.roofed)
    for (double x = draw.in(3, 9); x < decks.length_m; x += draw.in(9, 15))
      mesh.add(lamp_post(4.5), {x, 0.6, decks.height_m, 90});
}

}  // namespace

World car_park(Draw& draw) {
  World world;
  const Decks decks{.length_m = draw.in(36, 60),
                    .height_m = draw.in(2.95, 3.3),
                    .lanes = draw.count(1, 2),
                    .pillars_m = draw.in(4.9, 8.2),
                    .roofed = draw.chance(0.5)};
  const double z_m = decks.height_m;
  Mesh& mesh = world.mesh;
  for (int level = 1; level <= (decks.roofed ? 2 : 1); ++level)
    mesh.add_box({0, 0, level * z_m - Decks::kSlab_m}, {decks.length_m, decks.depth_m(), level * z_m}, 0.5);
  for (int level = 0; level < 2; ++level) {
    if (level == 0 || decks.roofed) add_level(mesh, draw, decks, level * z_m);
    add_cars(mesh, draw, decks, level * z_m);
  }
  add_ramp(mesh, decks);
  add_parapets(mesh, draw, decks, 0, 0, Decks::kLevel_m);
  add_parapets(mesh, draw, decks, z_m, decks.ramp_end_m(), decks.length_m);
  add_neighbours(mesh, draw, decks);
  world.walked_m = {Vector2d::Zero(), Vector2d(decks.length_m, decks.depth_m() + Decks::kRamp_m)};
  world.start_m = {draw.in(0.2, 0.8) * decks.length_m, 8, draw.chance(0.6) ? 0 : z_m};
  return world;
}

}  // namespace sweepscope::simulation
