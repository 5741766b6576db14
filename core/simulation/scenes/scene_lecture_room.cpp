#include <array>

#include "core/simulation/scenes/parts.hpp"
#include "core/simulation/scenes/scene.hpp"

namespace sweepscope::simulation {
namespace {

// The lecture room lies between (0, 0) and (kRoomX, kRoomY). Its front, with the boards, is at x = 0; the
// desks rise towards x = kRoomX. A level aisle along y = 0 leads to the door in that wall's foot, at y = 0.
constexpr double kRoomX_m = 15, kRoomY_m = 11, kRoomZ_m = 5.2;
constexpr double kAisle_m = 2.2, kFirstRow_m = 5.6, kRowDepth_m = 1.05, kRowRise_m = 0.28;
constexpr int kRows = 8;
constexpr Opening kDoor{9.6, 11.2, 0, 2.3};  // in the wall at y = 0, along x

/// One tier: its step, a long desk with a front panel, and folding seats behind.
void add_tier(Mesh& mesh, int row) {
  const double x = kFirstRow_m + row * kRowDepth_m, z = row * kRowRise_m;
  const double end_x = row + 1 == kRows ? kRoomX_m : x + kRowDepth_m;
  mesh.add_box({x, kAisle_m, 0}, {end_x, kRoomY_m, z + 0.02}, 0.5);
  for (const auto& [from_y, to_y] : {std::array{3.0, 6.4}, std::array{7.4, 10.8}}) {
    mesh.add_box({x + 0.05, from_y, z + 0.72}, {x + 0.42, to_y, z + 0.76}, 0.6);
    mesh.add_box({x + 0.05, from_y, z + 0.2}, {x + 0.08, to_y, z + 0.72}, 0.5);
    for (double y = from_y + 0.25; y + 0.5 < to_y; y += 0.62) {
      mesh.add_box({x + 0.62, y, z + 0.40}, {x + 0.95, y + 0.45, z + 0.44}, 0.4);
      mesh.add_box({x + 0.95, y, z + 0.44}, {x + 0.99, y + 0.45, z + 0.82}, 0.4);
    }
  }
}

void add_lecture_room(Mesh& mesh) {
  mesh.add_box({-0.3, -0.3, kRoomZ_m}, {kRoomX_m + 0.3, kRoomY_m + 0.3, kRoomZ_m + 0.4}, 0.8);
  mesh.add(wall(kRoomY_m, kRoomZ_m, 0.3), {0, 0, 0, 90})
      .add(wall(kRoomY_m, kRoomZ_m, 0.3), {kRoomX_m + 0.3, 0, 0, 90});
  mesh.add(wall(kRoomX_m, kRoomZ_m, 0.3), {0, kRoomY_m, 0, 0});
  mesh.add(wall(kRoomX_m, kRoomZ_m, 0.35,
                {{1.5, 3.5, 1.2, 3.6}, {4.4, 6.4, 1.2, 3.6}, kDoor, {12.4, 14.2, 1.2, 3.6}}),
           {0, -0.35, 0, 0});
  for (const double x : {1.5, 4.4, 12.4}) mesh.add_box({x - 0.1, -0.32, 1.1}, {x + 2.1, -0.28, 3.7}, 0.3);
  for (int row = 0; row < kRows; ++row) add_tier(mesh, row);
  // Boards in two rows, the lectern, a table, a projector, lamps, and panels on the far wall.
  for (const double y : {2.0, 5.0})
    mesh.add_box({0, y, 0.9}, {0.06, y + 2.8, 2.1}, 0.2).add_box({0.08, y, 2.25}, {0.14, y + 2.8, 3.45}, 0.2);
  mesh.add_box({0.4, 9.7, 0}, {1.1, 10.5, 1.1}, 0.5).add_box({0.35, 9.65, 1.1}, {1.15, 10.55, 1.16}, 0.5);
  mesh.add_box({2.3, 4.2, 0.72}, {3.0, 6.6, 0.76}, 0.6).add_box({2.4, 4.3, 0}, {2.45, 6.5, 0.72}, 0.5);
  mesh.add_box({5.6, 5.0, 4.1}, {6.1, 5.5, 4.3}, 0.8)
      .add(rod({5.85, 5.25, 4.3}, {5.85, 5.25, kRoomZ_m}, 0.03, 0.6));
  for (double x = 2; x < 14; x += 2.4) {
    mesh.add_box({x - 0.12, 0, kRoomZ_m - 0.35}, {x + 0.12, kRoomY_m, kRoomZ_m}, 0.8);
    for (const double y : {2.6, 7.2}) mesh.add_box({x + 1.1, y, 4.5}, {x + 1.3, y + 1.4, 4.58}, 0.95);
  }
  for (double x = 1; x < 14; x += 2.0) mesh.add_box({x, kRoomY_m - 0.06, 2.6}, {x + 1.2, kRoomY_m, 4.4}, 0.6);
  for (const double x : {1.5, 4.4, 12.4}) mesh.add_box({x, 0, 0.15}, {x + 2.0, 0.12, 0.8}, 0.9);
}

void add_campus(Mesh& mesh) {
  mesh.add_box({-90, -90, -0.3}, {90, 60, 0}, 0.3);
  // The lecture room's own building to either side, and buildings around the yard.
  mesh.add(facade({.length_m = 24, .floors = 3, .bays = 7}), {-24.4, -0.4, 0, 0});
  mesh.add(facade({.length_m = 26, .floors = 3, .bays = 8, .door_bay = 3}), {15.4, -0.4, 0, 0});
  mesh.add_box({-0.4, -0.35, kRoomZ_m}, {15.4, 0.65, 9.9}, 0.6);
  mesh.add(facade({.length_m = 44, .floors = 4, .bays = 12, .door_bay = 6}), {41, -27, 0, 180});
  mesh.add(facade({.length_m = 26, .floors = 3, .bays = 7}), {42, -0.5, 0, -90});
  mesh.add(facade({.length_m = 30, .floors = 2, .bays = 8}), {-25, -44, 0, 90});
  mesh.add(facade({.length_m = 20, .floors = 3, .bays = 6, .door_bay = 2}), {-3, -46, 0, 180});
  constexpr std::array<std::array<double, 4>, 13> kTrees = {{{4, -9, 8, 2.6},
                                                             {13, -13, 9, 3.0},
                                                             {22, -9.5, 8, 2.6},
                                                             {31, -14, 9, 3.0},
                                                             {39, -4, 7, 2.2},
                                                             {-5, -15, 9, 2.8},
                                                             {-14, -8, 8, 2.6},
                                                             {-20.5, -19, 7, 2.2},
                                                             {-9, -27, 8, 2.8},
                                                             {-19, -30, 9, 3.0},
                                                             {-5, -37, 7, 2.2},
                                                             {9, -23, 7, 2.0},
                                                             {24, -24, 7, 2.0}}};
  std::uint64_t seed = 70;
  for (const auto& [x, y, height_m, crown_m] : kTrees) {
    ++seed;
    mesh.add(seed % 4 == 0 ? bare_tree(height_m, seed) : tree(height_m, crown_m, seed), {x, y, 0, 0});
  }
  for (const double x : {0.0, 18.0, 30.0}) mesh.add(lamp_post(4.5), {x, -5.2, 0, -90});
  for (const double y : {-20.0, -33.0}) mesh.add(lamp_post(4.5), {-15, y, 0, 180});
  mesh.add(garden_bench(), {6.5, -8.2, 0, 0})
      .add(garden_bench(), {26, -11.5, 0, 180})
      .add(garden_bench(), {-17, -23, 0, 90});
  // Bicycle stands, and a low wall around the lawn.
  for (double x = 19; x < 27; x += 0.9) {
    for (const double y : {-2.6, -1.7}) mesh.add(rod({x, y, 0}, {x, y, 0.8}, 0.03, 0.6));
    mesh.add(rod({x, -2.6, 0.8}, {x, -1.7, 0.8}, 0.03, 0.6));
  }
  mesh.add_box({6, -18.6, 0}, {33, -18.2, 0.5}, 0.5).add_box({6, -18.6, 0}, {6.4, -13, 0.5}, 0.5);
}

}  // namespace

Scene lecture_room() {
  Scene scene;
  add_lecture_room(scene.mesh);
  add_campus(scene.mesh);
  // Before the boards and back, along the aisle, out of the door, and around the yard to another building.
  WalkSpec walk;
  walk.waypoints_m = {
      {3.8, 2.2},    {4.2, 5},    {3.9, 8.0},    {2.7, 9.2},     {1.5, 7.6},     {1.2, 4.4},
      {2.0, 2.2},    {4.6, 1.25}, {8, 1.2},      {9.9, 0.7},     {10.5, -1.2},   {11.2, -4.2},
      {15, -6.9},    {22, -6.4},  {30, -6.6},    {36, -9.5},     {38, -15},      {35, -20.6},
      {27, -21.4},   {18, -21.2}, {9.5, -20.4},  {3.0, -17.4},   {0, -12.5},     {-0.4, -7.6},
      {-5, -4.8},    {-13, -4.4}, {-19.6, -5.6}, {-21.8, -10.4}, {-17.2, -13.8}, {-12.4, -18.4},
      {-7.4, -22.2}, {-5.8, -27}, {-8.4, -31.4}, {-12.2, -34.4}, {-12.6, -39},   {-10.4, -42}};
  walk.closed = false;
  walk.duration_s = 274;
  walk.length_m = 184;
  walk.top_speed_mps = 1.9;
  walk.top_angular_rate_radps = 0.91;
  scene.motion = walk;
  return scene;
}

}  // namespace sweepscope::simulation
