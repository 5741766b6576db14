#include "core/rig_solve/plane_cells.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "core/rig_solve/surfaces.hpp"

namespace sweepscope {
namespace {

// Two walls and a floor that meet, 5 cm between points.
std::vector<Eigen::Vector3d> corner() {
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 1; i < 80; ++i)
    for (int j = 1; j < 80; ++j) {
      points_m.emplace_back(0.05 * i, 0.05 * j, 0);
      points_m.emplace_back(0.05 * i, 0, 0.05 * j);
      points_m.emplace_back(0, 0.05 * i, 0.05 * j);
    }
  return points_m;
}

TEST(PlaneCells, HoldFlatPartsOfTheSceneOnly) {
  const auto points_m = corner();
  const auto cells = plane_cells(points_m, {});
  std::size_t held = 0;
  for (const PlaneCell& cell : cells) {
    int axis = 0;
    EXPECT_GT(cell.normal.cwiseAbs().maxCoeff(&axis), 0.999);
    for (const std::uint32_t i : cell.points) EXPECT_NEAR(points_m[i][axis], 0, 0.2);
    held += cell.points.size();
  }
  EXPECT_GT(held, points_m.size() * 3 / 4);
}

TEST(PlaneCells, AreTheSameForAnyOrderOfThePoints) {
  auto points_m = corner();
  const auto cells = plane_cells(points_m, {});
  std::reverse(points_m.begin(), points_m.end());
  const auto reversed = plane_cells(points_m, {});
  ASSERT_EQ(cells.size(), reversed.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_LT((cells[i].centre_m - reversed[i].centre_m).norm(), 1e-12);
}

TEST(PlaneCells, ACloudWithoutSurfacesHasNone) {
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 20; ++k) points_m.emplace_back(0.1 * i, 0.1 * j, 0.1 * k);
  EXPECT_TRUE(plane_cells(points_m, {}).empty());
  EXPECT_TRUE(plane_cells({}, {}).empty());
}

TEST(Surfaces, APlaneCutIntoCellsIsOneSurface) {
  const auto cells = plane_cells(corner(), {});
  ASSERT_GT(cells.size(), 3u);
  const auto surfaces = surfaces_of(cells, 0.01);
  EXPECT_EQ(surfaces.size(), 3u);
  const auto held = std::accumulate(surfaces.begin(), surfaces.end(), std::size_t{0},
                                    [](std::size_t sum, const Surface& s) { return sum + s.cells.size(); });
  EXPECT_EQ(held, cells.size());
}

TEST(Surfaces, ParallelWallsApartStayTwo) {
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      points_m.emplace_back(0.05 * i, 0.05 * j, 0);
      points_m.emplace_back(3 + 0.05 * i, 0.05 * j, 0.05);
    }
  EXPECT_EQ(surfaces_of(plane_cells(points_m, {}), 0.01).size(), 2u);
}

}  // namespace
}  // namespace sweepscope
