#include "core/map/feature_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/map/clean_map.hpp"
#include "core/map/offset_map.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

class FeaturePoints : public testing::Test {
 protected:
  const Recording& recording_ = test::room(0.024);
  const FeatureSet features_ = extract_features(recording_, FeatureOptions(), Job()).value();

  static std::size_t in_scan(const FeatureList& list, std::size_t scan) {
    return list.scan_begin[scan + 1] - list.scan_begin[scan];
  }
};

TEST_F(FeaturePoints, AScansPointsAreAllItsReturnsWithTheFeaturesMarked) {
  constexpr std::size_t kScan = 30;
  const auto points = scan_points(recording_, features_, kScan);
  const auto ranges_m = recording_.ranges(recording_.scans[kScan]);
  ASSERT_EQ(points.size(), std::size_t(std::count_if(ranges_m.begin(), ranges_m.end(),
                                                     [](float range_m) { return std::isfinite(range_m); })));
  std::size_t edges = 0, planes = 0;
  for (const ScanPoint& point : points) {
    EXPECT_NEAR(point.p_in_laser_m.norm(), ranges_m[point.beam], 1e-4);
    edges += point.kind == FeatureKind::kEdge;
    planes += point.kind == FeatureKind::kPlane;
  }
  EXPECT_EQ(edges, in_scan(features_.edges, kScan));
  EXPECT_GT(edges, 0u);
  EXPECT_LE(planes, in_scan(features_.planes, kScan));
  EXPECT_GT(planes, in_scan(features_.planes, kScan) * 9 / 10);
}

TEST_F(FeaturePoints, PlanePointsAreLessCurvedThanTheRestOfTheirScan) {
  double plane_m = 0, all_m = 0;
  int planes = 0, all = 0;
  for (const ScanPoint& point : scan_points(recording_, features_, 30)) {
    if (!std::isfinite(point.curvature_m)) continue;
    all_m += point.curvature_m;
    ++all;
    if (point.kind != FeatureKind::kPlane) continue;
    plane_m += point.curvature_m;
    ++planes;
  }
  EXPECT_LT(plane_m / planes, 0.5 * all_m / all);
}

TEST_F(FeaturePoints, AMapsFeaturesAreTheBeamsThatWerePicked) {
  const std::vector<double> offsets_s = {0.024};
  const auto maps = build_maps(recording_, offsets_s, MapOptions(), Job()).value();
  const MapCloud& cloud = *maps.front().cloud;
  const std::vector<FeatureKind> kinds = feature_kinds(features_, cloud);
  ASSERT_EQ(kinds.size(), cloud.size());
  // By hand, for the scans that the map holds: every edge's instant is in the map, and marked there.
  std::size_t edges = 0;
  for (const Feature& edge : features_.edges.features) {
    const auto at = std::lower_bound(cloud.begin(), cloud.end(), edge.time_s,
                                     [](const MapPoint& p, double t_s) { return p.time_s < t_s; });
    if (at == cloud.end() || at->time_s != edge.time_s) continue;
    ++edges;
    ASSERT_EQ(kinds[std::size_t(at - cloud.begin())], FeatureKind::kEdge);
  }
  EXPECT_GT(edges, features_.edges.features.size() * 9 / 10);
  EXPECT_EQ(edges, std::size_t(std::count(kinds.begin(), kinds.end(), FeatureKind::kEdge)));
  const auto planes = std::size_t(std::count(kinds.begin(), kinds.end(), FeatureKind::kPlane));
  EXPECT_GT(planes, features_.planes.features.size() * 8 / 10);

  const FeatureCloud found = feature_cloud(cloud, kinds);
  EXPECT_EQ(found.cloud->size(), edges + planes);
  EXPECT_EQ(found.kinds.size(), found.cloud->size());

  const MapCloud::Ptr thin = thinned(maps.front().cloud, 0.2);
  const std::vector<FeatureKind> thin_kinds = feature_kinds(features_, *thin);
  EXPECT_EQ(thin_kinds.size(), thin->size());
  EXPECT_GT(std::count(thin_kinds.begin(), thin_kinds.end(), FeatureKind::kPlane), 0);
}

}  // namespace
}  // namespace sweepscope
