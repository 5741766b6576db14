#include "core/simulation/meshes/ray_caster.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

TEST(RayCaster, MeetsTheNearestSurface) {
  Mesh mesh = box({2, -1, -1}, {3, 1, 1}, 0.3);
  mesh.add_box({5, -1, -1}, {6, 1, 1}, 0.9);
  const auto hit = RayCaster(mesh).cast({0, 0.25, 0.1}, {1, 0, 0}, 30);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range_m, 2);
  EXPECT_DOUBLE_EQ(hit->cos_incidence, 1);
  EXPECT_DOUBLE_EQ(hit->albedo, 0.3);
}

TEST(RayCaster, TellsHowABeamGrazes) {
  const SinCos turn = sin_cos(radians(60));
  const auto hit = RayCaster(box({2, -20, -1}, {3, 20, 1})).cast({0, 0, 0.1}, {turn.cos, turn.sin, 0}, 30);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range_m, 4, 1e-12);
  EXPECT_NEAR(hit->cos_incidence, 0.5, 1e-12);
}

TEST(RayCaster, SeesNothingBeyondTheGreatestRange) {
  const RayCaster caster(box({2, -1, -1}, {3, 1, 1}));
  EXPECT_FALSE(caster.cast({0, 0, 0}, {1, 0, 0}, 1.999));
  EXPECT_FALSE(caster.cast({0, 0, 0}, {-1, 0, 0}, 30));
}

TEST(RayCaster, LetsNoBeamThroughWhereTrianglesMeet) {
  const Mesh ball = boulder({1, 1, 1}, 0.2, 3);
  const RayCaster caster(ball);
  for (const Triangle& t : ball.triangles) {
    for (const Vector3d& corner : {t.a, Vector3d((t.a + t.b) / 2), Vector3d(0.3 * t.b + 0.7 * t.c)}) {
      const auto hit = caster.cast({0, 0, 0}, corner.normalized(), 30);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->range_m, corner.norm(), 1e-7);
    }
  }
}

TEST(RayCaster, GivesTheEarlierOfTwoSurfacesInOnePlace) {
  Mesh mesh = box({2, -1, -1}, {3, 1, 1}, 0.3);
  mesh.add_box({2, -1, -1}, {3, 1, 1}, 0.9);
  const RayCaster caster(mesh);
  for (double y = -0.9; y < 0.9; y += 0.1)
    EXPECT_DOUBLE_EQ(caster.cast({0, y, 0.2}, {1, 0, 0}, 30)->albedo, 0.3);
}

TEST(RayCaster, SaysHowFarTheNearestSurfaceIs) {
  const RayCaster caster(box({0, 0, 0}, {2, 3, 4}));
  EXPECT_NEAR(caster.distance_m({1, 1.5, 5}, 2).value(), 1, 1e-12);  // above a face
  EXPECT_NEAR(caster.distance_m({-3, 1, -4}, 6).value(), 5, 1e-12);  // beside an edge
  EXPECT_NEAR(caster.distance_m({4, 5, 5}, 6).value(), 3, 1e-12);    // off a corner
  EXPECT_NEAR(caster.distance_m({1, 1.2, 2}, 6).value(), 1, 1e-12);  // inside
  EXPECT_FALSE(caster.distance_m({1, 1.5, 5}, 0.999));
  // Against the distance of a box, from everywhere.
  Random random(3, 0, 0);
  for (int i = 0; i < 500; ++i) {
    const Vector3d p(8 * random.uniform() - 3, 8 * random.uniform() - 3, 8 * random.uniform() - 2);
    const Vector3d outside = (p - Vector3d(1, 1.5, 2)).cwiseAbs() - Vector3d(1, 1.5, 2);
    const double expected_m = outside.maxCoeff() > 0 ? outside.cwiseMax(0).norm() : -outside.maxCoeff();
    EXPECT_NEAR(caster.distance_m(p, 20).value(), expected_m, 1e-9);
  }
}

}  // namespace
}  // namespace sweepscope::simulation
