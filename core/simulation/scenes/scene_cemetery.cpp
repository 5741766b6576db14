#include <array>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/scenes/scene.hpp"

namespace sweepscope::simulation {
namespace {

// Within a wall from (-kHalfX, -kHalfY) to (kHalfX, kHalfY); the chapel stands in the north, the gate in the
// south.
constexpr double kHalfX_m = 30, kHalfY_m = 24;

/// A slab with a pointed or level top, facing -y, on a plinth, its grave framed before it.
Mesh headstone(Random& random) {
  const double half_m = 0.28 + 0.18 * random.uniform(), height_m = 0.7 + 0.6 * random.uniform();
  const double peak_m = random.uniform() < 0.5 ? 0.18 : 0.0, albedo = 0.3 + 0.6 * random.uniform();
  const std::array<Vector2d, 5> outline = {Vector2d(-half_m, 0.15), Vector2d(half_m, 0.15),
                                           Vector2d(half_m, height_m), Vector2d(0, height_m + peak_m + 1e-3),
                                           Vector2d(-half_m, height_m)};
  Mesh mesh = extrusion(outline, 0.16, albedo);
  mesh.add_box({-half_m - 0.08, -0.08, 0}, {half_m + 0.08, 0.24, 0.15}, albedo);
  for (const double x : {-0.55, 0.45}) mesh.add_box({x, -1.9, 0}, {x + 0.1, 0, 0.14}, 0.5);
  return mesh.add_box({-0.55, -2.0, 0}, {0.55, -1.9, 0.14}, 0.5);
}

Mesh cross(double height_m) {
  Mesh mesh = box({-0.3, -0.2, 0}, {0.3, 0.2, 0.35}, 0.6);
  mesh.add_box({-0.09, -0.07, 0.35}, {0.09, 0.07, height_m}, 0.6);
  return mesh.add_box({-0.38, -0.07, 0.66 * height_m}, {0.38, 0.07, 0.66 * height_m + 0.18}, 0.6);
}

Mesh obelisk(double height_m) {
  Mesh mesh = box({-0.45, -0.45, 0}, {0.45, 0.45, 0.5}, 0.6);
  mesh.add(frustum(4, 0.42, 0.24, height_m - 0.8, 0.6), {0, 0, 0.5, 45});
  return mesh.add(frustum(4, 0.24, 0.01, 0.3, 0.6), {0, 0, height_m - 0.3, 45});
}

/// Rows of graves in the field between two corners; a few are crosses, fewer are obelisks, some are gone.
void add_graves(Mesh& yard, const Vector2d& low, const Vector2d& high, std::uint64_t seed) {
  Random random(seed, 0, 0);
  for (double y = low.y() + 2.2; y <= high.y(); y += 2.9) {
    for (double x = low.x() + 0.8; x <= high.x() - 0.6; x += 1.55) {
      const double kind = random.uniform();
      const Placement place{x + 0.15 * (random.uniform() - 0.5), y + 0.2 * (random.uniform() - 0.5), 0,
                            6 * (random.uniform() - 0.5)};
      if (kind < 0.12) continue;
      if (kind < 0.22)
        yard.add(cross(1.2 + random.uniform()), place);
      else if (kind < 0.27)
        yard.add(obelisk(2.0 + 1.2 * random.uniform()), place);
      else
        yard.add(headstone(random), place);
    }
  }
}

/// A nave with a pitched roof and a little tower, its door facing -y.
Mesh chapel() {
  Mesh mesh;
  mesh.add(wall(7, 4.2, 0.4, {{2.7, 4.3, 0, 2.6}}), {-3.5, 0, 0, 0})
      .add_box({-0.8, 0.3, 0}, {0.8, 0.35, 2.6}, 0.4);
  for (const double x : {-3.1, 3.5}) {
    mesh.add(wall(10, 4.2, 0.4, {{1.5, 2.5, 1.2, 3.4}, {4.5, 5.5, 1.2, 3.4}, {7.5, 8.5, 1.2, 3.4}}),
             {x, 0, 0, 90});
    mesh.add_box({x < 0 ? -3.2 : 3.15, 0, 0}, {x < 0 ? -3.15 : 3.2, 10, 4.2}, 0.3);
  }
  const std::array<Vector2d, 3> gable = {Vector2d(-3.9, 4.2), Vector2d(3.9, 4.2), Vector2d(0, 7.6)};
  mesh.add(extrusion(gable, 10.4, 0.4), {0, -0.2, 0, 0});
  mesh.add_box({-0.8, 1.0, 6.0}, {0.8, 2.6, 9.0}, 0.6)
      .add(frustum(4, 1.25, 0.02, 2.2, 0.4), {0, 1.8, 9.0, 45});
  for (const double x : {-3.9, 3.5})
    for (const double y : {0.2, 3.5, 6.8, 9.6}) mesh.add_box({x, y, 0}, {x + 0.4, y + 0.4, 3.2}, 0.6);
  return mesh;
}

void add_enclosure(Mesh& yard) {
  yard.add_box({-70, -70, -0.3}, {70, 70, 0}, 0.35);
  yard.add(wall(27.5, 2.1, 0.35), {-kHalfX_m, -kHalfY_m - 0.35, 0, 0});
  yard.add(wall(27.5, 2.1, 0.35), {2.5, -kHalfY_m - 0.35, 0, 0})
      .add(wall(60, 2.1, 0.35), {-kHalfX_m, kHalfY_m, 0, 0});
  for (const double x : {-kHalfX_m, kHalfX_m + 0.35}) yard.add(wall(48, 2.1, 0.35), {x, -kHalfY_m, 0, 90});
  for (double x = -30; x <= 30; x += 5)
    for (const double y : {-kHalfY_m, kHalfY_m})
      yard.add_box({x - 0.3, y - 0.45, 0}, {x + 0.3, y + 0.45, 2.5}, 0.6);
  for (double y = -20; y <= 20; y += 5)
    for (const double x : {-kHalfX_m, kHalfX_m})
      yard.add_box({x - 0.45, y - 0.3, 0}, {x + 0.45, y + 0.3, 2.5}, 0.6);
  // The gate: two tall piers and a grille.
  for (const double x : {-2.5, 2.5})
    yard.add_box({x - 0.4, -24.6, 0}, {x + 0.4, -23.8, 3.2}, 0.6)
        .add(frustum(4, 0.6, 0.02, 0.6, 0.6), {x, -24.2, 3.2, 45});
  for (double x = -2.0; x <= 2.01; x += 0.25) yard.add(rod({x, -24.2, 0.1}, {x, -24.2, 2.3}, 0.02, 0.4, 5));
}

void add_plants(Mesh& yard) {
  constexpr std::array<std::array<double, 4>, 18> kTrees = {{{-26, -20, 8, 2.6},
                                                             {-16, -1.9, 9, 2.8},
                                                             {-3.4, -12, 7, 2.2},
                                                             {3.4, -12, 7, 2.2},
                                                             {-3.4, -4, 7, 2.2},
                                                             {3.4, -4, 7, 2.2},
                                                             {16, -1.9, 9, 2.8},
                                                             {26, -20, 8, 2.6},
                                                             {29, 4, 7, 1.8},
                                                             {-28.5, 5, 8, 2.0},
                                                             {-26.8, 22, 9, 3.0},
                                                             {-12, 22.8, 7, 2.2},
                                                             {26.8, 22, 9, 3.0},
                                                             {12, 22.8, 7, 2.2},
                                                             {-14, 1.9, 6, 2.0},
                                                             {14, 1.9, 6, 2.0},
                                                             {-10.5, 12, 8, 2.6},
                                                             {10.5, 12, 8, 2.6}}};
  std::uint64_t seed = 40;
  for (const auto& [x, y, height_m, crown_m] : kTrees) {
    ++seed;
    yard.add(seed % 3 == 0 ? bare_tree(height_m, seed) : tree(height_m, crown_m, seed), {x, y, 0, 0});
  }
  for (const double x : {-27.0, -12.0, 7.0, 20.0}) yard.add_box({x, -22.6, 0}, {x + 7, -22.0, 1.1}, 0.4);
  for (const double side : {-1.0, 1.0})
    for (double y = -19; y <= -6; y += 3.2)
      yard.add(boulder({0.45, 0.45, 0.7}, 0.15, static_cast<std::uint64_t>(y + 60)),
               {side * 3.2, y - 0.8, 0.6, 0});
  for (const Placement& place :
       {Placement{-29.4, -1.2, 0, 90}, Placement{20.0, 1.5, 0, 0}, Placement{-10.5, 1.2, 0, 0}})
    yard.add(garden_bench(), place);
  // A fountain's basin where the paths cross.
  yard.add(prism(12, 1.1, 0.55, 0.6), {0, 0, 0, 0})
      .add(frustum(10, 0.22, 0.12, 1.9, 0.6))
      .add(prism(12, 0.55, 0.12, 0.6), {0, 0, 1.3, 0});
}

}  // namespace

Scene cemetery() {
  Scene scene;
  add_enclosure(scene.mesh);
  add_graves(scene.mesh, {-24, -20}, {-4, -3}, 21);
  add_graves(scene.mesh, {4, -20}, {24, -3}, 22);
  add_graves(scene.mesh, {-24, 3.5}, {-8, 19}, 23);
  add_graves(scene.mesh, {8, 3.5}, {24, 19}, 24);
  add_plants(scene.mesh);
  scene.mesh.add(chapel(), {0, 8.5, 0, 0});
  // From the gate, around the fountain, to a grave in the east and back, around both northern fields, and to
  // the gate.
  WalkSpec walk;
  walk.waypoints_m = {{0.6, -20.5}, {0.8, -14},   {0.9, -7},      {2.1, -2.0},  {2.5, 0.7},   {0.6, 2.6},
                      {-2.0, 1.6},  {-2.2, -1.0}, {0.4, -2.4},    {5, -0.7},    {10, 0.2},    {16, 0.1},
                      {22.5, -0.7}, {25.4, -3},   {26.0, -6},     {26.4, -8.4}, {27.3, -9.2}, {28.2, -8.4},
                      {28.1, -5},   {27.4, 0},    {26.0, 6},      {25.7, 13},   {23, 20},     {15, 20.4},
                      {8.2, 19.8},  {6.0, 14},    {5.6, 7.5},     {2.5, 3.6},   {-3, 3.6},    {-6, 7.5},
                      {-6.2, 14},   {-8.5, 19.8}, {-15, 20.4},    {-22.8, 20},  {-25.6, 14},  {-25.7, 6},
                      {-25.5, -2},  {-25.5, -10}, {-25.0, -18.2}, {-21, -21.2}, {-12, -21.2}, {-5, -21.5},
                      {-0.7, -22}};
  walk.duration_s = 287;
  walk.length_m = 236;
  walk.top_speed_mps = 1.4;
  walk.top_angular_rate_radps = 0.74;
  scene.motion = walk;
  return scene;
}

}  // namespace sweepscope::simulation
