#include "core/map/surface_thickness.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/core/map/noisy_surfaces.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::NoisySurfaces;

// The value below which a part of the finite ones lies.
float quantile(std::vector<float> values, double part) {
  std::erase_if(values, [](float value) { return std::isnan(value); });
  if (values.empty()) return std::nanf("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

double part_without(const std::vector<float>& values) {
  const auto nan = std::count_if(values.begin(), values.end(), [](float value) { return std::isnan(value); });
  return double(nan) / double(values.size());
}

// 4 m by 4 m, 1250 points per square metre, at a slant to the grid.
NoisySurfaces wall(double noise_m, double shift_m = 0) {
  NoisySurfaces map;
  return map.patch(20000, {3.3, 1.7, 0.4}, {1.6, 1.2, 0}, {0.1, 0, 2}, noise_m, shift_m);
}

TEST(SurfaceThickness, IsTheNoiseOfASharpWall) {
  for (const double noise_m : {0.005, 0.010, 0.020}) {
    const std::vector<float> thickness_m = surface_thickness_m(wall(noise_m).cloud);
    EXPECT_LT(part_without(thickness_m), 0.01);
    EXPECT_NEAR(quantile(thickness_m, 0.5), noise_m, 0.12 * noise_m);
    EXPECT_LT(quantile(thickness_m, 0.99), 1.4 * noise_m);
  }
}

TEST(SurfaceThickness, LayersOfForwardAndBackwardSweepsAreOneThickWall) {
  for (const double shift_m : {0.025, 0.050, 0.080}) {
    const std::vector<float> thickness_m = surface_thickness_m(wall(0.010, shift_m).cloud);
    EXPECT_LT(part_without(thickness_m), 0.02);
    EXPECT_NEAR(quantile(thickness_m, 0.5), std::hypot(0.010, shift_m), 0.12 * shift_m);
    // Layers farther apart are seen one by one in a part of the cubes.
    if (shift_m <= 0.05) {
      EXPECT_GT(quantile(thickness_m, 0.05), 0.7 * shift_m);
    }
  }
}

TEST(SurfaceThickness, TheCornersOfASharpRoomStayThin) {
  NoisySurfaces room;
  room.patch(20000, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, 0.01)
      .patch(20000, {0, 2, 0}, {2, 0, 0}, {0, 0, 2}, 0.01)
      .patch(20000, {0, 0, -2}, {2, 0, 0}, {0, 2, 0}, 0.01);
  const std::vector<float> thickness_m = surface_thickness_m(room.cloud);
  std::vector<float> at_edges_m;
  for (std::size_t i = 0; i < room.cloud.size(); ++i) {
    const MapPoint& p = room.cloud[i];
    const int near = (p.x > 1.9f) + (p.y > 1.9f) + (p.z < -1.9f);
    if (near >= 2) at_edges_m.push_back(thickness_m[i]);
  }
  ASSERT_GT(at_edges_m.size(), 1000u);
  // A wall 0.8 m above the rig has 27 mm at 5 ms.
  EXPECT_LT(quantile(at_edges_m, 0.5), 0.020);
  EXPECT_LT(quantile(at_edges_m, 0.95), 0.025);
}

TEST(SurfaceThickness, APipeIsNotThickForBeingRound) {
  NoisySurfaces map;
  for (int i = 0; i < 6000; ++i) {
    const double angle_rad = 2 * simulation::kPi * map.random().uniform();
    const double radius_m = 0.3 + 0.005 * map.random().normal();
    map.add({radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 3 * map.random().uniform()},
            static_cast<std::uint32_t>(i % 2));
  }
  EXPECT_LT(quantile(surface_thickness_m(map.cloud), 0.9), 0.012);
}

TEST(SurfaceThickness, NothingIsSaidOfSparsePointsOfLinesAndOfFoliage) {
  NoisySurfaces sparse, line, foliage;
  sparse.patch(100, {0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 0.01);
  EXPECT_EQ(part_without(surface_thickness_m(sparse.cloud)), 1);
  for (int i = 0; i < 3000; ++i) line.add({i * 0.001, 0.003 * line.random().normal(), 0}, 0);
  EXPECT_EQ(part_without(surface_thickness_m(line.cloud)), 1);
  for (int i = 0; i < 30000; ++i)
    foliage.add(
        {3 * foliage.random().uniform(), 3 * foliage.random().uniform(), 3 * foliage.random().uniform()},
        static_cast<std::uint32_t>(i % 2));
  EXPECT_GT(part_without(surface_thickness_m(foliage.cloud)), 0.8);
}

TEST(SurfaceThickness, FewScanLinesDoNotMakeASurface) {
  // Three lines 0.1 m apart, the middle one 30 mm behind: a bent surface would go through all of them.
  NoisySurfaces map;
  for (int i = 0; i < 3000; ++i) {
    const int line = i % 3 - 1;
    map.add({2 * map.random().uniform(), 0.1 * line, (line == 0 ? 0.03 : 0) + 0.002 * map.random().normal()},
            0);
  }
  EXPECT_EQ(part_without(surface_thickness_m(map.cloud)), 1);
}

TEST(SurfaceThickness, WhereBothDirectionsAreAskedForOneAloneSaysNothing) {
  NoisySurfaces both = wall(0.01);
  ThicknessOptions options;
  options.both_directions = true;
  EXPECT_LT(part_without(surface_thickness_m(both.cloud, options)), 0.02);
  for (MapPoint& point : both.cloud) point.sweep = 4;
  EXPECT_EQ(part_without(surface_thickness_m(both.cloud, options)), 1);
  EXPECT_LT(part_without(surface_thickness_m(both.cloud)), 0.02);
}

TEST(SurfaceThickness, KnowsTheSurfacesDirection) {
  const auto map = wall(0.01);
  const std::vector<LocalSurface> surfaces = local_surfaces(map.cloud);
  const Eigen::Vector3f across = Vector3d(1.6, 1.2, 0).cross(Vector3d(0.1, 0, 2)).normalized().cast<float>();
  std::size_t right = 0;
  for (const LocalSurface& surface : surfaces) right += std::abs(surface.normal.dot(across)) > 0.97f;
  EXPECT_GT(double(right) / double(surfaces.size()), 0.95);
}

TEST(SurfaceThickness, IsTheSameForAnyNumberOfThreads) {
  const auto map = wall(0.01, 0.03);
  const std::vector<float> many = surface_thickness_m(map.cloud);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<float> single = surface_thickness_m(map.cloud);
  EXPECT_EQ(std::memcmp(many.data(), single.data(), many.size() * sizeof(float)), 0);
}

TEST(SurfaceThickness, OfNothingIsNothing) {
  EXPECT_TRUE(surface_thickness_m(MapCloud()).empty());
}

}  // namespace
}  // namespace sweepscope
