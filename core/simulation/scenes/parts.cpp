#include "core/simulation/scenes/parts.hpp"

#include <array>
#include <cmath>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

constexpr double kBark = 0.35, kLeaves = 0.45;

Vector3d outwards(double azimuth_rad, double slope, double length_m) {
  const SinCos turn = sin_cos(azimuth_rad);
  const double flat = length_m / std::sqrt(1 + slope * slope);
  return {flat * turn.cos, flat * turn.sin, flat * slope};
}

}  // namespace

Mesh facade(const FacadeSpec& spec) {
  constexpr double kRecess_m = 0.18;
  const double bay_m = spec.length_m / spec.bays, height_m = spec.floors * spec.floor_m;
  Mesh mesh = box({0, kRecess_m, 0}, {spec.length_m, 1.0, height_m}, 0.35);
  for (int floor = 0; floor < spec.floors; ++floor) {
    const double z = floor * spec.floor_m;
    std::vector<Opening> openings;
    for (int bay = 0; bay < spec.bays; ++bay) {
      const double middle_m = (bay + 0.5) * bay_m;
      const bool door = floor == 0 && bay == spec.door_bay;
      const double half_m = door ? 0.8 : 0.27 * bay_m;
      openings.push_back({middle_m - half_m, middle_m + half_m, door ? 0.0 : 1.0, door ? 2.3 : 2.6});
      if (door) {
        mesh.add_box({middle_m - 1.3, -1.1, 2.5}, {middle_m + 1.3, 0, 2.62}, 0.6);
        continue;
      }
      mesh.add_box({middle_m - half_m - 0.1, -0.10, z + 0.92}, {middle_m + half_m + 0.1, 0.1, z + 1.0}, 0.8);
      mesh.add_box({middle_m - 0.04, 0.08, z + 1.0}, {middle_m + 0.04, kRecess_m, z + 2.6}, 0.8);
    }
    mesh.add(wall(spec.length_m, spec.floor_m, kRecess_m, openings, 0.65), {0, 0, z, 0});
    mesh.add_box({0, -0.08, z + spec.floor_m - 0.15}, {spec.length_m, 0, z + spec.floor_m}, 0.7);
  }
  mesh.add_box({-0.1, -0.12, 0}, {(spec.door_bay < 0 ? spec.bays : spec.door_bay) * bay_m, 0, 0.5}, 0.5);
  return mesh.add_box({-0.2, -0.35, height_m}, {spec.length_m + 0.2, 1.0, height_m + 0.25}, 0.6);
}

Mesh tree(double height_m, double crown_m, std::uint64_t seed) {
  Random random(seed, 1, 0);
  const double trunk_m = 0.4 * height_m, radius_m = 0.035 * height_m;
  Mesh mesh = frustum(9, 1.25 * radius_m, 0.8 * radius_m, trunk_m + 0.5, kBark);
  const Vector3d fork(0, 0, trunk_m);
  constexpr int kLimbs = 5;
  for (int limb = 0; limb < kLimbs; ++limb) {
    const double azimuth_rad = 2 * kPi * (limb + 0.6 * random.uniform()) / kLimbs;
    const Vector3d tip = fork + outwards(azimuth_rad, 0.8 + 0.6 * random.uniform(), 0.75 * crown_m);
    mesh.add(rod(fork, tip, 0.4 * radius_m, kBark, 5));
    const double size_m = crown_m * (0.42 + 0.16 * random.uniform());
    mesh.add(boulder({size_m, size_m, 0.8 * size_m}, 0.22, random.next(), kLeaves),
             {tip.x(), tip.y(), tip.z(), 0});
  }
  const double top_m = 0.62 * crown_m;
  return mesh.add(boulder({top_m, top_m, top_m}, 0.22, random.next(), kLeaves), {0, 0, height_m - top_m, 0});
}

Mesh bare_tree(double height_m, std::uint64_t seed) {
  Random random(seed, 2, 0);
  const double radius_m = 0.03 * height_m;
  Mesh mesh = frustum(9, 1.2 * radius_m, 0.5 * radius_m, 0.75 * height_m, kBark);
  for (int limb = 0; limb < 9; ++limb) {
    const double up = 0.3 + 0.05 * limb, azimuth_rad = 2.4 * limb + random.uniform();
    const Vector3d foot(0, 0, up * height_m);
    const Vector3d knee = foot + outwards(azimuth_rad, 0.7 + 0.5 * random.uniform(), 0.28 * height_m);
    mesh.add(rod(foot, knee, 0.3 * radius_m, kBark, 5));
    for (const double aside : {-0.6, 0.1, 0.7}) {
      const double slope = 0.4 + random.uniform();
      mesh.add(
          rod(knee, knee + outwards(azimuth_rad + aside, slope, 0.2 * height_m), 0.15 * radius_m, kBark, 4));
    }
  }
  return mesh;
}

Mesh lamp_post(double height_m) {
  Mesh mesh = frustum(8, 0.10, 0.05, height_m, 0.6);
  mesh.add(prism(8, 0.16, 0.5, 0.6)).add(rod({0, 0, height_m - 0.1}, {1.2, 0, height_m + 0.1}, 0.035, 0.6));
  return mesh.add_box({0.9, -0.12, height_m + 0.05}, {1.6, 0.12, height_m + 0.2}, 0.8);
}

Mesh car(bool tall, double albedo) {
  constexpr double kWidth_m = 1.78;
  const std::array<Vector2d, 7> body = {Vector2d(-2.15, 0.28), Vector2d(2.1, 0.28), Vector2d(2.2, 0.5),
                                        Vector2d(2.1, 0.72),   Vector2d(1.1, 0.9),  Vector2d(-2.0, 0.95),
                                        Vector2d(-2.2, 0.6)};
  const std::array<Vector2d, 4> cabin = {Vector2d(-1.95, 0.93), Vector2d(1.05, 0.88), Vector2d(0.3, 1.43),
                                         Vector2d(-1.4, 1.47)};
  const std::array<Vector2d, 5> box_body = {Vector2d(-2.3, 0.3), Vector2d(2.2, 0.3), Vector2d(2.2, 0.95),
                                            Vector2d(1.5, 2.05), Vector2d(-2.3, 2.15)};
  Mesh mesh;
  if (tall) {
    mesh.add(extrusion(box_body, kWidth_m + 0.1, albedo), {0, -kWidth_m / 2 - 0.05, 0, 0});
  } else {
    mesh.add(extrusion(body, kWidth_m, albedo), {0, -kWidth_m / 2, 0, 0});
    mesh.add(extrusion(cabin, kWidth_m - 0.3, 0.3), {0, -kWidth_m / 2 + 0.15, 0, 0});
  }
  for (const double x : {-1.35, 1.35})
    for (const double y : {-0.92, 0.72}) mesh.add(rod({x, y, 0.31}, {x, y + 0.2, 0.31}, 0.31, 0.2, 14));
  for (const double y : {-1.05, 0.90}) mesh.add_box({0.65, y, 0.9}, {0.75, y + 0.15, 1.05}, 0.4);
  return mesh;
}

Mesh garden_bench() {
  Mesh mesh;
  for (const double y : {0.0, 0.15, 0.30}) mesh.add_box({0, y, 0.42}, {1.7, y + 0.12, 0.46}, 0.4);
  for (const double z : {0.56, 0.74}) mesh.add_box({0, 0.44, z}, {1.7, 0.48, z + 0.12}, 0.4);
  for (const double x : {0.15, 1.47}) {
    mesh.add_box({x, 0.02, 0}, {x + 0.08, 0.44, 0.42}, 0.5);
    mesh.add_box({x, 0.44, 0}, {x + 0.08, 0.52, 0.88}, 0.5);
  }
  return mesh;
}

}  // namespace sweepscope::simulation
