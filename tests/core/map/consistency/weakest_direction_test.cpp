#include "core/map/consistency/weakest_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A corridor along x: a floor and two walls, whose normals scatter by up to so much about each axis.
FacedSurfaces corridor(double scatter_rad = 0) {
  FacedSurfaces faced;
  for (int i = 0; i < 60; ++i) {
    const double x_m = 0.2 * (i - 30), tilt = scatter_rad * std::sin(37.0 * i);
    faced.add({x_m, 0.4 * std::sin(i), -1}, Vector3d(tilt, 0, 1).normalized(), 0);
    faced.add({x_m, 1, 0.3 * std::cos(i)}, Vector3d(tilt, -1, 0).normalized(), 0);
    faced.add({x_m, -1, 0.3 * std::cos(2 * i)}, Vector3d(tilt, 1, 0).normalized(), 0);
  }
  return faced;
}

void add_end_wall(FacedSurfaces& faced, double distance_m) {
  for (int i = 0; i < 10; ++i)
    faced.add({6, 0.3 * std::sin(i), 0.3 * std::cos(i)}, Vector3d::UnitX(), distance_m);
}

TEST(WeakestDirection, OfACorridorIsAlongIt) {
  EXPECT_NEAR(std::abs(corridor().weakest().direction.x()), 1, 1e-6);
  EXPECT_EQ(corridor().weakest().facing, 0);
}

TEST(WeakestDirection, NormalsThatScatterDoNotFaceIt) {
  const WeakestDirection weakest = corridor(0.4).weakest();
  EXPECT_GT(std::abs(weakest.direction.x()), 0.98);
  EXPECT_EQ(weakest.facing, 0);
}

TEST(WeakestDirection, MatchesOfAWallAcrossItDo) {
  FacedSurfaces faced = corridor(0.4);
  add_end_wall(faced, 0);
  EXPECT_NEAR(faced.weakest().facing, 10, 0.3);
}

TEST(WeakestDirection, MatchesFarFromTheirSurfacesCountLittle) {
  FacedSurfaces faced = corridor();
  add_end_wall(faced, 0.3);
  EXPECT_LT(faced.weakest().facing, 0.5);
}

TEST(WeakestDirection, WithoutMatchesNoneFacesAnyDirection) {
  EXPECT_EQ(FacedSurfaces().weakest().facing, 0);
  EXPECT_NEAR(FacedSurfaces().weakest().direction.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace sweepscope
