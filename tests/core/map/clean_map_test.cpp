#include "core/map/clean_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

// A wall of 50 x 50 points, 2 cm apart, and one point 3 m before it.
MapCloud::Ptr wall_and_stray() {
  MapCloud::Ptr cloud(new MapCloud);
  for (int i = 0; i < 2500; ++i) {
    MapPoint point{};
    point.x = 5.0f;
    point.y = 0.02f * static_cast<float>(i % 50);
    point.z = 0.02f * static_cast<float>(i / 50);
    point.time_s = i * 1e-3;
    point.sweep = static_cast<std::uint32_t>(i / 100);
    cloud->push_back(point);
  }
  MapPoint stray = cloud->back();
  stray.x = 2.0f;
  stray.time_s = 2.5;
  cloud->push_back(stray);
  return cloud;
}

TEST(CleanMap, ThinningKeepsOnePointPerVoxelWithItsOwnTimeAndSweep) {
  const MapCloud::Ptr cloud = wall_and_stray(), kept = thinned(cloud, 0.1);
  EXPECT_GT(kept->size(), 90U);
  EXPECT_LT(kept->size(), 160U);
  std::size_t of_wall = 0;
  for (const MapPoint& point : *kept) {
    if (point.x < 3) continue;
    ++of_wall;
    EXPECT_EQ(point.sweep, std::uint32_t(std::lround(point.time_s * 1e3)) / 100);
  }
  EXPECT_GT(of_wall, 90U);
  EXPECT_TRUE(std::is_sorted(kept->begin(), kept->end(),
                             [](const MapPoint& a, const MapPoint& b) { return a.time_s < b.time_s; }));
}

TEST(CleanMap, OutlierRemovalTakesTheStrayPointAndLeavesTheWall) {
  const MapCloud::Ptr kept = without_outliers(wall_and_stray());
  EXPECT_EQ(kept->size(), 2500U);
  for (const MapPoint& point : *kept) EXPECT_EQ(point.x, 5.0f);
}

}  // namespace
}  // namespace sweepscope
