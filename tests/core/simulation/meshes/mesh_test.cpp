#include "core/simulation/meshes/mesh.hpp"

#include <gtest/gtest.h>

#include "core/simulation/meshes/ray_caster.hpp"

namespace sweepscope::simulation {
namespace {

/// How high a mesh stands at a place in plan.
double height_at(const RayCaster& caster, double x_m, double y_m) {
  const auto hit = caster.cast({x_m, y_m, 20}, {0, 0, -1}, 40);
  return hit ? 20 - hit->range_m : -1;
}

TEST(Mesh, StairsRiseStepByStep) {
  const RayCaster caster(stairs(10, 0.17, 0.30, 2));
  for (int step = 0; step < 10; ++step) {
    EXPECT_NEAR(height_at(caster, step * 0.30 + 0.01, 1), (step + 1) * 0.17, 1e-12);
    EXPECT_NEAR(height_at(caster, step * 0.30 + 0.29, 1), (step + 1) * 0.17, 1e-12);
  }
}

TEST(Mesh, AWallIsOpenWhereItIsSaidToBe) {
  const RayCaster caster(wall(6, 3, 0.2, {{4, 5, 0, 2}, {1, 2, 1, 2}}));
  const auto open = [&](double x_m, double z_m) { return !caster.cast({x_m, -5, z_m}, {0, 1, 0}, 30); };
  EXPECT_TRUE(open(1.5, 1.5));
  EXPECT_TRUE(open(4.5, 0.1));
  EXPECT_FALSE(open(1.5, 0.5));
  EXPECT_FALSE(open(1.5, 2.5));
  EXPECT_FALSE(open(3.0, 1.5));
  EXPECT_FALSE(open(5.5, 1.5));
}

TEST(Mesh, APlacedPartIsTurnedLeftAndThenMoved) {
  Mesh mesh;
  mesh.add(box({0, 0, 0}, {2, 1, 1}), {10, 20, 0, 90});
  const RayCaster caster(mesh);
  EXPECT_EQ(height_at(caster, 9.5, 21.5), 1);
  EXPECT_EQ(height_at(caster, 11.5, 20.5), -1);
}

TEST(Mesh, APrismHasTheSidesAskedFor) {
  const RayCaster caster(prism(6, 1, 2));
  EXPECT_NEAR(caster.cast({5, 0, 1}, {-1, 0, 0}, 30)->range_m, 4, 1e-9);
  EXPECT_NEAR(caster.cast({0, 5, 1}, {0, -1, 0}, 30)->range_m, 5 - 0.8660254037844386, 1e-9);
  EXPECT_EQ(height_at(caster, 0, 0), 2);
}

}  // namespace
}  // namespace sweepscope::simulation
