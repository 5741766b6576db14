#include "core/loam/feature_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

struct MapPointOfLine {
  Eigen::Vector3f p_m;
  std::uint32_t line;
  int direction;
};

// Points about the origin, so that cells with negative indices are met as well, on 40 scan lines.
std::vector<MapPointOfLine> cloud(int count) {
  simulation::Random random(5, 2, 0);
  std::vector<MapPointOfLine> points;
  for (int i = 0; i < count; ++i) {
    const auto line = std::uint32_t(40 * random.uniform());
    const Eigen::Vector3d p_m(6 * random.uniform() - 3, 6 * random.uniform() - 3, 2 * random.uniform() - 1);
    points.push_back({p_m.cast<float>(), line, line % 2 == 0 ? 1 : -1});
  }
  return points;
}

bool sees(SweepFilter filter, int direction) {
  return filter == SweepFilter::kAny || (filter == SweepFilter::kForward) == (direction > 0);
}

std::vector<float> nearest_by_brute_force(std::vector<MapPointOfLine> points, const Eigen::Vector3f& p_m,
                                          double radius_m, SweepFilter filter, int most, int per_line) {
  const auto squared = [&](const MapPointOfLine& p) { return (p.p_m - p_m).squaredNorm(); };
  std::sort(points.begin(), points.end(),
            [&](const auto& a, const auto& b) { return squared(a) < squared(b); });
  std::map<std::uint32_t, int> of_line;
  std::vector<float> found;
  for (const MapPointOfLine& point : points) {
    if (std::ssize(found) == most || squared(point) >= radius_m * radius_m) break;
    if (sees(filter, point.direction) && ++of_line[point.line] <= per_line) found.push_back(squared(point));
  }
  return found;
}

class Nearest : public testing::TestWithParam<std::tuple<int, SweepFilter, int>> {};

TEST_P(Nearest, EqualsBruteForce) {
  const auto [level, filter, per_line] = GetParam();
  const std::vector<MapPointOfLine> points = cloud(3000);
  FeatureMap map(0.3, false);
  for (const MapPointOfLine& point : points) map.insert(point.p_m, point.line, point.direction);
  simulation::Random random(6, 2, 0);
  for (int query = 0; query < 50; ++query) {
    const Eigen::Vector3f p_m(float(7 * random.uniform() - 3.5), float(7 * random.uniform() - 3.5),
                              float(2 * random.uniform() - 1));
    Neighbours found;
    map.nearest(p_m, level, filter, 8, per_line, found);
    const auto expected =
        nearest_by_brute_force(points, p_m, map.search_radius_m(level), filter, 8, per_line);
    ASSERT_EQ(std::size_t(found.count), expected.size());
    for (int i = 0; i < found.count; ++i) {
      EXPECT_FLOAT_EQ(found.squared_distance_m2[i], expected[i]);
      EXPECT_FLOAT_EQ((found.p_m[i] - p_m).squaredNorm(), expected[i]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(LevelsFiltersAndLimits, Nearest,
                         testing::Combine(testing::Range(0, FeatureMap::kLevels),
                                          testing::Values(SweepFilter::kBackward, SweepFilter::kForward,
                                                          SweepFilter::kAny),
                                          testing::Values(1, 2, 8)));

TEST(FeatureMap, CountsTheScanLinesAmongTheNeighbours) {
  FeatureMap map(0.6, false);
  for (const std::uint32_t line : {4u, 4u, 7u, 9u, 7u}) map.insert({0.01f * float(line), 0, 0}, line, 1);
  Neighbours found;
  map.nearest({0, 0, 0}, 0, SweepFilter::kAny, 10, 2, found);
  EXPECT_EQ(found.count, 5);
  EXPECT_EQ(found.lines, 3);
  map.nearest({0, 0, 0}, 0, SweepFilter::kAny, 2, 2, found);
  EXPECT_EQ(found.lines, 1);
}

TEST(FeatureMap, AThinnedPlaceKeepsTheFirstPointOfEachDirection) {
  FeatureMap map(0.6, true);
  map.insert({0.05f, 0.05f, 0.05f}, 1, 1);
  map.insert({0.06f, 0.05f, 0.05f}, 2, 1);
  EXPECT_EQ(map.size(), 1u);
  map.insert({0.06f, 0.05f, 0.05f}, 3, -1);
  EXPECT_EQ(map.size(), 2u);
  map.insert({0.25f, 0.05f, 0.05f}, 4, 1);  // in the next third of the cell
  EXPECT_EQ(map.size(), 3u);
  Neighbours found;
  map.nearest({0.06f, 0.05f, 0.05f}, 0, SweepFilter::kForward, 1, 1, found);
  ASSERT_EQ(found.count, 1);
  EXPECT_EQ(found.line[0], 1u);
}

TEST(FeatureMap, CoarserLevelsAreThinnedMore) {
  FeatureMap map(0.6, true);
  for (int i = 0; i < 100; ++i)
    map.insert({0.19f * float(i % 10), 0.19f * float(i / 10), 0}, std::uint32_t(i), 1);
  const auto around = [&](int level) {
    Neighbours found;
    map.nearest({0.9f, 0.9f, 0}, level, SweepFilter::kAny, 10, 1, found);
    return std::sqrt(found.squared_distance_m2[found.count - 1]);
  };
  EXPECT_GT(around(2), 1.5f * around(0));
}

TEST(FeatureMap, LevelsReachTwiceAsFarEach) {
  const FeatureMap map(0.6);
  EXPECT_DOUBLE_EQ(map.search_radius_m(0), double(0.6f) * 5 / 6);
  EXPECT_EQ(map.level_for(0.1), 0);
  EXPECT_EQ(map.level_for(0.51), 1);
  EXPECT_EQ(map.level_for(1e6), FeatureMap::kLevels - 1);
}

TEST(FeatureMap, IsEmptyOnceCleared) {
  FeatureMap map;
  map.insert({1, 2, 3}, 0, 1);
  map.clear();
  EXPECT_EQ(map.size(), 0u);
  Neighbours found;
  map.nearest({1, 2, 3}, 0, SweepFilter::kAny, 10, 1, found);
  EXPECT_EQ(found.count, 0);
  map.insert({1, 2, 3}, 0, 1);
  EXPECT_EQ(map.size(), 1u);
}

}  // namespace
}  // namespace sweepscope
