#include "core/map/sweep_clouds.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

constexpr double kCloudsTruth_s = 0.024;

// Every sweep's cloud, moved by its pose, holds the points of the map, in their order.
void expect_the_map(const Recording& recording, const MapOptions& options, std::size_t min_sweeps) {
  const auto prepared = prepare(recording, {}, Job()).value();
  const auto clouds = SweepClouds::create(prepared, kCloudsTruth_s, options, Job());
  ASSERT_TRUE(clouds) << clouds.error().message;
  const OffsetMap map = build_maps(prepared, {&kCloudsTruth_s, 1}, options, Job()).value().front();
  EXPECT_EQ(clouds->moving(), map.moving);
  EXPECT_GE(clouds->size(), min_sweeps);
  std::size_t next = 0;
  for (std::size_t i = 0; i < clouds->size(); ++i) {
    const SweepCloud cloud = clouds->at(i);
    EXPECT_EQ(cloud.begin_s, clouds->begin_s(i));
    EXPECT_EQ(cloud.end_s, clouds->end_s(i));
    for (const MapPoint& point : cloud.points.points) {
      ASSERT_LT(next, map.cloud->size());
      const MapPoint& same = map.cloud->points[next++];
      ASSERT_EQ(point.time_s, same.time_s);
      ASSERT_EQ(point.sweep, same.sweep);
      ASSERT_GE(point.time_s, cloud.begin_s);
      ASSERT_LE(point.time_s, cloud.end_s);
      const Eigen::Vector3d in_map_m = cloud.map_from_base * point.getVector3fMap().cast<double>();
      ASSERT_LT((in_map_m - same.getVector3fMap().cast<double>()).norm(), 2e-5);
    }
  }
  EXPECT_EQ(next, map.cloud->size());
}

TEST(SweepClouds, OfAStationaryRigAreTheMapInPieces) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.offset_s = kCloudsTruth_s;
  expect_the_map(bench.record(), {}, 8);
}

// A recording that ends one scan after a reversal, or begins one scan before it.
TEST(SweepClouds, AFewScansAtAnEndBelongToTheNeighbour) {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.offset_s = kCloudsTruth_s;
  const Recording whole = bench.record();
  const std::vector<Sweep> sweeps = find_sweeps(whole.motor).sweeps;
  const std::vector<std::size_t> of_scan = assign_sweeps(whole.scans, sweeps, kCloudsTruth_s);
  std::vector<std::size_t> begins;  // scans that begin a sweep
  for (std::size_t i = 1; i < of_scan.size(); ++i)
    if (of_scan[i] != of_scan[i - 1]) begins.push_back(i);
  ASSERT_GT(begins.size(), 5U);
  const double first_s = whole.scans.front().first_beam_s;
  const Recording cut = window(whole, whole.scans[begins[0] - 1].first_beam_s - first_s - 1e-4,
                               whole.scans[begins.back()].first_beam_s - first_s + 1e-4);
  ASSERT_EQ(cut.scans.size(), begins.back() - begins[0] + 2);
  const auto prepared = prepare(cut, {}, Job()).value();
  const auto clouds = SweepClouds::create(prepared, kCloudsTruth_s, {}, Job()).value();
  EXPECT_EQ(clouds.size(), begins.size() - 1);
  for (std::size_t i = 0; i < clouds.size(); ++i) EXPECT_GT(clouds.end_s(i) - clouds.begin_s(i), 0.3) << i;
  expect_the_map(cut, {}, begins.size() - 1);
}

TEST(SweepClouds, OfAMovingRigLieInTheBaseFrameOfTheirFirstBeam) {
  expect_the_map(test::simulated("metro-station", kCloudsTruth_s, 12).recording, {}, 22);
}

TEST(SweepClouds, FollowPosesFromElsewhere) {
  const Simulation& simulation = test::simulated("metro-station", kCloudsTruth_s, 12);
  MapOptions options;
  for (const TruthPose& pose : simulation.truth)
    options.poses.push_back({pose.time_s, pose.position_m, pose.orientation});
  expect_the_map(simulation.recording, options, 22);
}

TEST(SweepClouds, HoldTheMotionOfARigThatIsTakenToBeStationary) {
  const Simulation& simulation = test::simulated("metro-station", kCloudsTruth_s, 12);
  const auto prepared = prepare(simulation.recording, {}, Job()).value();
  MapOptions options;
  options.assume = RigKind::kStationary;
  const auto clouds = SweepClouds::create(prepared, kCloudsTruth_s, options, Job()).value();
  EXPECT_FALSE(clouds.moving());
  for (std::size_t i = 0; i < clouds.size(); ++i)
    EXPECT_EQ(clouds.at(i).map_from_base.translation_m, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace sweepscope
