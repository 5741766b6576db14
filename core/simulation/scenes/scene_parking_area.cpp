#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/scenes/scene.hpp"

namespace sweepscope::simulation {
namespace {

/// Cars side by side, 2.6 m apart from (x, y) on, some places empty, one in five a van.
void add_row(Mesh& area, double x_m, double y_m, int places, double yaw_deg, std::uint64_t seed) {
  Random random(seed, 0, 0);
  for (int place = 0; place < places; ++place) {
    const bool empty = random.uniform() < 0.2, tall = random.uniform() < 0.2;
    const double along_m = x_m + 2.6 * place + 0.2 * (random.uniform() - 0.5);
    const double across_m = y_m + 0.5 * (random.uniform() - 0.5);
    const double turned_deg = yaw_deg + 5 * (random.uniform() - 0.5), albedo = 0.25 + 0.7 * random.uniform();
    if (!empty) area.add(car(tall, albedo), {along_m, across_m, 0, turned_deg});
  }
}

void add_ground(Mesh& area) {
  area.add_box({-60, -50, -0.3}, {60, 50, 0}, 0.25);
  // The pavement before the building, and islands with kerbs between the rows.
  area.add_box({-29, 10.6, 0}, {29, 16, 0.13}, 0.4);
  area.add_box({-15.3, -5.3, 0}, {15.3, -4.1, 0.14}, 0.4).add_box({-29, -17.9, 0}, {29, -17.5, 0.14}, 0.4);
  for (const double x : {-16.5, 15.5}) area.add_box({x, -9.4, 0}, {x + 1.0, 0.0, 0.14}, 0.4);
}

void add_surroundings(Mesh& area) {
  area.add(facade({.length_m = 50, .floors = 3, .bays = 14, .door_bay = 5}), {-25, 16, 0, 0});
  area.add(facade({.length_m = 22, .floors = 2, .bays = 6, .floor_m = 3.4}), {29, 12, 0, -90});
  // A brick wall with piers in the south, garages in the west.
  area.add(wall(56, 1.9, 0.3), {-28, -21.5, 0, 0});
  for (double x = -28; x <= 28; x += 4) area.add_box({x - 0.25, -21.7, 0}, {x + 0.25, -21.0, 2.3}, 0.5);
  const FacadeSpec garages{.length_m = 24, .floors = 1, .bays = 8, .floor_m = 2.8};
  area.add(facade(garages), {-30, -14, 0, 90});
  for (const double x : {-13.0, -4.5, 4.0, 12.5})
    area.add(lamp_post(6.0), {x, -4.7, 0, x < 0 ? 90.0 : -90.0});
  for (const double x : {-22.0, 0.0, 22.0}) area.add(lamp_post(5.0), {x, -18.2, 0, 90});
  for (const double x : {-12.0, 10.0, 17.0})
    area.add(tree(7, 2.6, static_cast<std::uint64_t>(x + 50)), {x, -19.6, 0, 0});
  for (const double x : {-20.0, 20.0})
    area.add(tree(6, 2.0, static_cast<std::uint64_t>(x + 90)), {0.8 * x, -4.7, 0, 0});
  // A ticket machine, a height bar at the way in, bollards before the door.
  area.add_box({-16.3, -9.0, 0.14}, {-15.8, -8.5, 1.7}, 0.7);
  for (const double y : {-1.0, 3.6}) area.add(rod({27.5, y, 0}, {27.5, y, 2.6}, 0.08, 0.7, 8));
  area.add(rod({27.5, -1.0, 2.5}, {27.5, 3.6, 2.5}, 0.08, 0.8, 8));
  for (double x = -10; x < -1; x += 1.5) area.add(prism(8, 0.09, 0.9, 0.7), {x, 10.9, 0, 0});
}

}  // namespace

Scene parking_area() {
  Scene scene;
  add_ground(scene.mesh);
  add_surroundings(scene.mesh);
  add_row(scene.mesh, -20.5, 8.0, 8, 90, 11);
  add_row(scene.mesh, 6.6, 8.0, 7, 90, 12);
  add_row(scene.mesh, -13.6, -1.6, 11, 90, 13);
  add_row(scene.mesh, -13.6, -7.8, 11, -90, 14);
  add_row(scene.mesh, -20.5, -16.0, 17, -90, 15);
  // Around the middle rows, along the building, back between the cars.
  WalkSpec walk;
  walk.waypoints_m = {{-13, 2.2},    {-6, 1.9},    {2, 2.4},    {10, 2.2},    {16, 1.4},      {18.9, -4.8},
                      {15.8, -11.2}, {8, -12.2},   {0, -11.6},  {-8, -12.2},  {-15.2, -11.2}, {-18.8, -5.5},
                      {-21.6, 2},    {-22.9, 9.0}, {-17, 12.4}, {-8, 12.6},   {-0.6, 12.2},   {2.4, 9.0},
                      {0.8, 5.6},    {-5, 4.6},    {-11, 4.8},  {-15.4, 4.6}, {-15.9, 2.9}};
  walk.duration_s = 208;
  walk.length_m = 155;
  walk.top_speed_mps = 1.5;
  walk.top_angular_rate_radps = 0.61;
  scene.motion = walk;
  return scene;
}

}  // namespace sweepscope::simulation
