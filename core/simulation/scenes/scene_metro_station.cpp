#include <array>

#include "core/simulation/scenes/scene.hpp"

namespace sweepscope::simulation {
namespace {

// An abandoned station's platform: x along the tracks, the platform's floor at z = 0, the hexagonal pillar at
// the origin. A track on either side, stairs at the left (x < 0) and right ends.
constexpr double kHalfLength_m = 24, kPlatformEdge_m = 8, kWall_m = 12, kCeiling_m = 6.4, kTrackBed_m = -1.1;

constexpr double kRise_m = 0.165, kGoing_m = 0.30, kStairWidth_m = 3.6, kStairFoot_m = 14.5;
constexpr int kSteps = 29;

Mesh bench() {
  Mesh mesh;
  for (const double y : {0.0, 0.14, 0.28}) mesh.add_box({0, y, 0.42}, {1.8, y + 0.11, 0.46}, 0.4);
  for (const double z : {0.58, 0.74}) mesh.add_box({0, 0.42, z}, {1.8, 0.45, z + 0.11}, 0.4);
  for (const double x : {0.2, 1.55}) mesh.add_box({x, 0, 0}, {x + 0.06, 0.45, 0.42}, 0.3);
  for (const double x : {0.2, 1.55}) mesh.add_box({x, 0.45, 0}, {x + 0.06, 0.49, 0.9}, 0.3);
  return mesh;
}

/// A sign of the station's name, hung from the ceiling across the platform.
Mesh hanging_sign() {
  Mesh mesh = box({-0.06, -1.3, 2.55}, {0.06, 1.3, 3.0}, 0.9);
  for (const double y : {-1.1, 1.1}) mesh.add(rod({0, y, 3.0}, {0, y, kCeiling_m}, 0.025, 0.4));
  return mesh;
}

/// A flight climbing along +x, between parapets, with a lamp box above each wall.
Mesh flight() {
  const double run_m = kSteps * kGoing_m, top_m = kSteps * kRise_m;
  Mesh mesh = stairs(kSteps, kRise_m, kGoing_m, kStairWidth_m, 0.5);
  const std::array<Vector2d, 4> parapet = {Vector2d(0, 0), Vector2d(run_m, 0), Vector2d(run_m, top_m + 1.0),
                                           Vector2d(0, 1.0)};
  for (const double y : {-0.25, kStairWidth_m}) mesh.add(extrusion(parapet, 0.25, 0.7), {0, y, 0, 0});
  for (const double y : {0.10, kStairWidth_m - 0.10})
    mesh.add(rod({0.1, y, 0.9}, {run_m, y, top_m + 0.9}, 0.03, 0.8));
  return mesh.add_box({run_m, -0.25, 0}, {run_m + 1.0, kStairWidth_m + 0.25, top_m}, 0.5);
}

void add_hall_shell(Mesh& hall) {
  hall.add_box({-kHalfLength_m, -kPlatformEdge_m, -0.25}, {kHalfLength_m, kPlatformEdge_m, 0}, 0.5);
  hall.add_box({-kHalfLength_m, -kPlatformEdge_m + 0.4, kTrackBed_m},
               {kHalfLength_m, kPlatformEdge_m - 0.4, -0.25}, 0.3);
  hall.add_box({-kHalfLength_m, -kWall_m, kTrackBed_m - 0.2}, {kHalfLength_m, kWall_m, kTrackBed_m}, 0.2);
  for (const double side : {-1.0, 1.0}) {
    for (const double rail : {9.2, 10.64})
      hall.add_box({-kHalfLength_m, side * rail - 0.04, kTrackBed_m},
                   {kHalfLength_m, side * rail + 0.04, -0.95}, 0.8);
    hall.add_box({-kHalfLength_m, side * 12.15 - 0.15, kTrackBed_m},
                 {kHalfLength_m, side * 12.15 + 0.15, kCeiling_m}, 0.6);
    // The side walls' pilasters, panels and cable trays.
    for (double x = -22; x <= 22; x += 4)
      hall.add_box({x - 0.25, side * 11.85 - 0.15, kTrackBed_m}, {x + 0.25, side * 11.85 + 0.15, kCeiling_m},
                   0.6);
    for (double x = -20; x <= 20; x += 8)
      hall.add_box({x - 1.3, side * 11.95 - 0.05, 0.6}, {x + 1.3, side * 11.95 + 0.05, 2.4}, 0.9);
    hall.add_box({-kHalfLength_m, side * 11.8 - 0.2, 3.3}, {kHalfLength_m, side * 11.8 + 0.2, 3.4}, 0.4);
  }
  for (const double end : {-1.0, 1.0})
    hall.add_box({end * 24.2 - 0.2, -kWall_m, kTrackBed_m}, {end * 24.2 + 0.2, kWall_m, 8.5}, 0.6);
}

void add_hall_ceiling(Mesh& hall) {
  // Open above the stairs, so that the flights go on upwards.
  const double half_m = kStairWidth_m / 2 + 0.25;
  hall.add_box({-17, -kWall_m, kCeiling_m}, {17, kWall_m, kCeiling_m + 0.3}, 0.8);
  for (const double end : {-1.0, 1.0}) {
    const double low_x = end < 0 ? -kHalfLength_m : 17, high_x = end < 0 ? -17 : kHalfLength_m;
    hall.add_box({low_x, -kWall_m, kCeiling_m}, {high_x, -half_m, kCeiling_m + 0.3}, 0.8);
    hall.add_box({low_x, half_m, kCeiling_m}, {high_x, kWall_m, kCeiling_m + 0.3}, 0.8);
    hall.add_box({low_x, -half_m, 8.2}, {high_x, half_m, 8.5}, 0.8);
  }
  for (double x = -12; x <= 12; x += 4)
    hall.add_box({x - 0.2, -kWall_m, kCeiling_m - 0.55}, {x + 0.2, kWall_m, kCeiling_m}, 0.7);
  for (const double y : {-5.0, 5.0})
    hall.add_box({-16, y - 0.15, kCeiling_m - 0.45}, {16, y + 0.15, kCeiling_m}, 0.7);
  for (double x = -10; x <= 10; x += 4)
    for (const double y : {-2.5, 2.5})
      hall.add_box({x - 0.7, y - 0.1, kCeiling_m - 0.9}, {x + 0.7, y + 0.1, kCeiling_m - 0.8}, 0.95);
}

void add_hall_furniture(Mesh& hall) {
  hall.add(prism(6, 0.45, kCeiling_m, 0.7));
  hall.add(frustum(6, 0.45, 0.75, 0.5, 0.7), {0, 0, kCeiling_m - 0.5, 0}).add(prism(6, 0.55, 0.25, 0.4));
  for (const double x : {-13.6, 13.6})
    for (const double y : {-6.4, 6.4})
      hall.add_box({x - 0.25, y - 0.25, 0}, {x + 0.25, y + 0.25, kCeiling_m}, 0.7);
  hall.add(bench(), {-3.4, -7.5, 0, 0}).add(bench(), {5.5, 7.4, 0, 180}).add(bench(), {-7.5, 7.4, 0, 180});
  hall.add(bench(), {0.2, -1.6, 0, 30}).add(frustum(10, 0.22, 0.28, 0.9, 0.4), {-1.8, 1.1, 0, 0});
  hall.add(hanging_sign(), {-6, 0, 0, 0}).add(hanging_sign(), {6, 0, 0, 0});
  // Ticket machines, a kiosk and a timetable's board.
  for (const double y : {-3.2, 2.4}) hall.add_box({-14.3, y, 0}, {-13.6, y + 0.8, 1.85}, 0.6);
  hall.add_box({14.2, 2.6, 0}, {15.6, 4.8, 2.6}, 0.5).add_box({13.9, 2.4, 2.6}, {15.7, 5.0, 2.75}, 0.5);
  for (const double x : {7.9, 9.4}) hall.add(rod({x, -7.4, 0}, {x, -7.4, 2.1}, 0.035, 0.5));
  hall.add_box({7.9, -7.43, 0.9}, {9.4, -7.37, 2.1}, 0.9);
}

}  // namespace

Scene metro_station() {
  Scene scene;
  add_hall_shell(scene.mesh);
  add_hall_ceiling(scene.mesh);
  add_hall_furniture(scene.mesh);
  scene.mesh.add(flight(), {kStairFoot_m, -kStairWidth_m / 2, 0, 0});
  scene.mesh.add(flight(), {-kStairFoot_m, kStairWidth_m / 2, 0, 180});
  // Three times around the pillar, ever closer, with a look at either flight of stairs.
  WalkSpec walk;
  walk.waypoints_m = {{-6, -5.2},   {0, -5.6},    {6, -5.2},    {9.6, -2.8},  {10.3, 0.4},  {8.8, 3.4},
                      {4.6, 5.0},   {-0.5, 5.3},  {-5.4, 5.0},  {-9, 3.2},    {-10.4, 0.4}, {-8.6, -1.9},
                      {-5.4, -3.6}, {-0.5, -4.4}, {4.4, -3.9},  {6.4, -0.6},  {4.6, 3.2},   {0.2, 4.2},
                      {-3.2, 2.6},  {-3.9, -0.6}, {-2.0, -3.0}, {1.6, -3.1},  {3.5, -0.8},  {2.9, 2.1},
                      {0, 3.2},     {-3.8, 3.1},  {-7.0, 0.9},  {-9.8, -1.6}, {-9.6, -4.3}};
  walk.duration_s = 159;
  walk.length_m = 117;
  walk.top_speed_mps = 1.3;
  walk.top_angular_rate_radps = 0.44;
  scene.motion = walk;
  return scene;
}

}  // namespace sweepscope::simulation
