#include <array>

#include "core/simulation/scenes/scene.hpp"

namespace sweepscope::simulation {
namespace {

// The room lies between (0, 0) and (kLength, kWidth); windows are in the wall at y = kWidth, the door at x =
// 0.
constexpr double kLength_m = 7.4, kWidth_m = 5.6, kHeight_m = 2.9;

Mesh table(double length_m, double width_m) {
  Mesh mesh = box({0, 0, 0.71}, {length_m, width_m, 0.75}, 0.7);
  for (const double x : {0.04, length_m - 0.10})
    for (const double y : {0.04, width_m - 0.10}) mesh.add_box({x, y, 0}, {x + 0.06, y + 0.06, 0.71}, 0.3);
  return mesh;
}

/// Faces +x, its middle over the origin.
Mesh chair() {
  Mesh mesh = box({-0.22, -0.22, 0.43}, {0.22, 0.22, 0.47}, 0.4);
  for (const double x : {-0.21, 0.17})
    for (const double y : {-0.21, 0.17}) mesh.add_box({x, y, 0}, {x + 0.04, y + 0.04, 0.43}, 0.3);
  for (const double y : {-0.21, 0.17}) mesh.add_box({-0.21, y, 0.47}, {-0.17, y + 0.04, 0.90}, 0.3);
  return mesh.add_box({-0.20, -0.21, 0.65}, {-0.17, 0.21, 0.90}, 0.4);
}

/// Open shelves against a wall at y = 0, with boxes and rows of books of many heights.
Mesh shelf(double length_m, double height_m, int boards) {
  constexpr double kDepth_m = 0.35;
  Mesh mesh = box({0, 0, 0}, {length_m, 0.02, height_m}, 0.5);
  for (const double x : {0.0, length_m / 2, length_m - 0.03})
    mesh.add_box({x, 0.02, 0}, {x + 0.03, kDepth_m, height_m}, 0.5);
  const double rise_m = (height_m - 0.05) / boards;
  for (int board = 0; board <= boards; ++board)
    mesh.add_box({0, 0.02, board * rise_m}, {length_m, kDepth_m, board * rise_m + 0.03}, 0.5);
  for (int board = 0; board < boards; ++board) {
    for (int slot = 0; slot < 2; ++slot) {
      const double x = slot * length_m / 2 + 0.06, z = board * rise_m + 0.03;
      const double books_m = (0.25 + 0.15 * ((board * 2 + slot * 3) % 4)) * length_m / 2;
      mesh.add_box({x, 0.02, z}, {x + books_m, 0.20 + 0.03 * ((board + slot) % 3), z + 0.6 * rise_m}, 0.3);
    }
  }
  return mesh;
}

Mesh cupboard(double length_m, double depth_m, double height_m) {
  Mesh mesh = box({0, 0, 0.08}, {length_m, depth_m, height_m}, 0.7);
  mesh.add_box({0.03, 0, 0}, {length_m - 0.03, depth_m - 0.05, 0.08}, 0.2);
  for (const double x : {length_m / 2 - 0.08, length_m / 2 + 0.05})
    mesh.add_box({x, depth_m, 1.0}, {x + 0.03, depth_m + 0.04, 1.25}, 0.9);
  return mesh;
}

Mesh radiator(double length_m) {
  Mesh mesh;
  for (double x = 0; x + 0.06 <= length_m; x += 0.10)
    mesh.add_box({x, -0.10, 0.12}, {x + 0.06, 0, 0.72}, 0.9);
  return mesh;
}

void add_room_shell(Mesh& room) {
  room.add_box({-0.3, -0.3, -0.2}, {kLength_m + 0.3, kWidth_m + 0.5, 0}, 0.4);
  room.add_box({-0.3, -0.3, kHeight_m}, {kLength_m + 0.3, kWidth_m + 0.5, kHeight_m + 0.2}, 0.9);
  room.add(wall(kLength_m, kHeight_m, 0.2), {0, -0.2, 0, 0});
  room.add(wall(kWidth_m, kHeight_m, 0.2), {kLength_m + 0.2, 0, 0, 90});
  // The door stands back in its frame.
  room.add(wall(kWidth_m, kHeight_m, 0.2, {{0.9, 1.85, 0, 2.1}}), {0, 0, 0, 90});
  room.add_box({-0.20, 0.9, 0}, {-0.15, 1.85, 2.1}, 0.5);
  // Three windows in recesses, radiators below.
  room.add(
      wall(kLength_m, kHeight_m, 0.3, {{0.6, 2.3, 0.9, 2.4}, {2.9, 4.6, 0.9, 2.4}, {5.2, 6.9, 0.9, 2.4}}),
      {0, kWidth_m, 0, 0});
  room.add_box({0, kWidth_m + 0.22, 0}, {kLength_m, kWidth_m + 0.26, kHeight_m}, 0.3);
  for (const double x : {0.7, 3.0, 5.3}) {
    room.add(radiator(1.5), {x, kWidth_m - 0.02, 0, 0});
    room.add_box({x - 0.15, kWidth_m - 0.12, 0.86}, {x + 1.65, kWidth_m + 0.22, 0.9}, 0.8);
    room.add_box({x + 0.72, kWidth_m + 0.14, 0.9}, {x + 0.78, kWidth_m + 0.22, 2.4}, 0.8);
  }
}

void add_room_ceiling(Mesh& room) {
  for (const double x : {2.4, 4.9})
    room.add_box({x, 0, kHeight_m - 0.3}, {x + 0.25, kWidth_m, kHeight_m}, 0.8);
  for (const double x : {1.0, 3.6, 6.0})
    for (const double y : {1.5, 3.9}) {
      room.add_box({x, y, 2.45}, {x + 0.2, y + 1.3, 2.53}, 0.9);
      for (const double along : {0.2, 1.08})
        room.add_box({x + 0.09, y + along, 2.53}, {x + 0.11, y + along + 0.02, kHeight_m}, 0.5);
    }
}

void add_room_furniture(Mesh& room) {
  room.add(table(2.4, 1.1), {2.5, 2.2, 0, 0});
  constexpr std::array<Placement, 6> kChairs = {{{2.95, 1.95, 0, 85},
                                                 {3.75, 1.85, 0, 97},
                                                 {4.5, 2.0, 0, 80},
                                                 {3.0, 3.55, 0, -95},
                                                 {4.3, 3.7, 0, -70},
                                                 {5.35, 2.8, 0, 175}}};
  for (const Placement& place : kChairs) room.add(chair(), place);
  room.add(shelf(2.4, 2.1, 5), {1.2, 0, 0, 0});
  room.add(cupboard(1.6, 0.6, 1.9), {4.4, 0, 0, 0});
  room.add_box({4.5, 0.1, 1.9}, {5.0, 0.5, 2.25}, 0.6).add_box({5.3, 0.05, 1.9}, {5.85, 0.45, 2.15}, 0.4);
  room.add_box({6.5, 0, 0}, {7.0, 0.5, 0.7}, 0.5)
      .add(boulder({0.3, 0.3, 0.45}, 0.25, 5), {6.75, 0.28, 1.15, 0});
  // A desk at the far wall with two screens, a board above, a coat stand and a bin in the corner.
  room.add(table(1.8, 0.8), {7.35, 2.2, 0, 90});
  for (const double y : {2.5, 3.2})
    room.add_box({7.1, y, 0.85}, {7.15, y + 0.55, 1.2}, 0.2)
        .add_box({7.1, y + 0.2, 0.75}, {7.3, y + 0.35, 0.85}, 0.2);
  room.add(chair(), {6.3, 3.1, 0, 15});
  room.add_box({7.36, 1.9, 1.4}, {7.4, 4.3, 2.4}, 0.95);
  room.add(prism(8, 0.03, 1.8, 0.3), {0.4, 5.0, 0, 0})
      .add(frustum(8, 0.16, 0.3, 0.5, 0.3), {0.4, 5.0, 1.2, 0});
  room.add(frustum(10, 0.13, 0.17, 0.35, 0.4), {6.9, 4.9, 0, 0});
  room.add(cupboard(0.9, 0.45, 1.3), {0, 3.1, 0, -90});
  room.add_box({0.05, 2.3, 1.3}, {0.4, 2.8, 1.6}, 0.7);
}

}  // namespace

Scene room(int position) {
  Scene scene;
  add_room_shell(scene.mesh);
  add_room_ceiling(scene.mesh);
  add_room_furniture(scene.mesh);
  constexpr std::array<std::array<double, 4>, 6> kStands = {{{0.9, 2.2, 1.25, 12},
                                                             {1.5, 4.6, 1.15, -40},
                                                             {5.6, 4.7, 1.30, -125},
                                                             {6.1, 1.4, 1.20, 150},
                                                             {3.6, 1.3, 1.35, 75},
                                                             {3.3, 4.3, 1.10, -160}}};
  const auto& [x, y, z, yaw_deg] = kStands[static_cast<std::size_t>(position - 1)];
  scene.motion = Stand{{x, y, z}, yaw_deg, 1.5};
  return scene;
}

}  // namespace sweepscope::simulation
