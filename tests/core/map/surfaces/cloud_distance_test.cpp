#include "core/map/surfaces/cloud_distance.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "tests/core/map/noisy_surfaces.hpp"

namespace sweepscope {
namespace {

using test::NoisySurfaces;

MapCloud scattered(int points, double size_m, std::uint64_t seed) {
  NoisySurfaces map;
  simulation::Random random(seed, 8, 0);
  for (int i = 0; i < points; ++i)
    map.add(size_m * Eigen::Vector3d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5),
            0);
  return map.cloud;
}

std::vector<float> by_trying_all(const MapCloud& from, const MapCloud& to, float cap_m) {
  std::vector<float> distances_m;
  for (const MapPoint& p : from) {
    float min_m2 = cap_m * cap_m;
    for (const MapPoint& q : to)
      min_m2 = std::min(min_m2, (p.getVector3fMap() - q.getVector3fMap()).squaredNorm());
    distances_m.push_back(std::sqrt(min_m2));
  }
  return distances_m;
}

TEST(CloudDistance, AgreesWithTryingAllPoints) {
  // About one point per cube of the search, then many, then hardly any.
  for (const double size_m : {1.0, 0.4, 3.0}) {
    const MapCloud from = scattered(1500, size_m, 1), to = scattered(1500, size_m, 2);
    const std::vector<float> found_m = distances_to_m(from, to), true_m = by_trying_all(from, to, 0.2f);
    for (std::size_t i = 0; i < from.size(); ++i) ASSERT_NEAR(found_m[i], true_m[i], 1e-5) << i;
  }
}

TEST(CloudDistance, BeyondTheCapIsTheCap) {
  MapCloud far = scattered(100, 1, 1);
  for (MapPoint& point : far) point.x += 50;
  DistanceOptions options;
  options.cap_m = 0.3;
  for (const float distance_m : distances_to_m(scattered(100, 1, 2), far, options))
    EXPECT_EQ(distance_m, 0.3f);
  EXPECT_EQ(distances_to_m(scattered(3, 1, 2), MapCloud()), std::vector<float>(3, 0.2f));
  EXPECT_TRUE(distances_to_m(MapCloud(), far).empty());
}

TEST(CloudDistance, OfAMapToItselfIsNothing) {
  const MapCloud map = scattered(2000, 2, 1);
  for (const float distance_m : distances_to_m(map, map)) ASSERT_EQ(distance_m, 0);
}

TEST(CloudDistance, IsTheSameForAnyNumberOfThreads) {
  const MapCloud from = scattered(20000, 2, 1), to = scattered(20000, 2, 2);
  const std::vector<float> many = distances_to_m(from, to);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(distances_to_m(from, to), many);
}

}  // namespace
}  // namespace sweepscope
