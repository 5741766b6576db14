#include "core/map/offset_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kMapTruth_s = 0.024;

std::vector<OffsetMap> maps_of(const Recording& recording, const std::vector<double>& offsets_s) {
  return build_maps(recording, offsets_s, MapOptions(), Job()).value();
}

// In the hall, the middle half of the points' distances from the ceiling 1.5 m above the rig, which a wrong
// offset tilts one way in one sweep and the other way in the next.
double ceiling_thickness_m(const OffsetMap& map) {
  std::vector<double> heights_m;
  for (const MapPoint& point : map.cloud->points)
    if (point.z > 1.2f && std::abs(point.x) < 2.5f && std::abs(point.y) > 2 && std::abs(point.y) < 3.9f)
      heights_m.push_back(point.z);
  EXPECT_GT(heights_m.size(), 1000u);
  std::sort(heights_m.begin(), heights_m.end());
  return heights_m[heights_m.size() * 3 / 4] - heights_m[heights_m.size() / 4];
}

class StandingInTheHall : public testing::Test {
 protected:
  static Recording record() {
    test::Bench bench;
    bench.mesh = test::hall();
    bench.offset_s = kMapTruth_s;
    bench.noise_m = 0.005;
    return bench.record();
  }
  const Recording recording_ = record();
  const std::vector<OffsetMap> maps_ = maps_of(recording_, {kMapTruth_s, kMapTruth_s + 5 * kMs});
};

TEST_F(StandingInTheHall, TheCeilingIsSharpAtTheOffsetAndThickerFiveMillisecondsOff) {
  const double at_truth_m = ceiling_thickness_m(maps_[0]), off_m = ceiling_thickness_m(maps_[1]);
  EXPECT_LT(at_truth_m, 0.012);
  EXPECT_GT(off_m, 4 * at_truth_m);
}

TEST_F(StandingInTheHall, AtTheOffsetPointsLieWhereTheWallsAre) {
  std::size_t on_wall = 0;
  for (const MapPoint& p : maps_[0].cloud->points)
    if (std::abs(std::abs(p.x) - 6) < 0.03 || std::abs(std::abs(p.y) - 4) < 0.03 ||
        std::abs(std::abs(p.z) - 1.5) < 0.03)
      ++on_wall;
  EXPECT_GT(double(on_wall) / double(maps_[0].cloud->size()), 0.75);
}

TEST_F(StandingInTheHall, ItsPosesAreTheIdentity) {
  EXPECT_FALSE(maps_[0].moving);
  EXPECT_FALSE(maps_[0].trajectory.empty());
  for (const StampedPose& pose : maps_[0].trajectory) {
    EXPECT_EQ(pose.position_m, Eigen::Vector3d::Zero());
    EXPECT_EQ(pose.orientation.w(), 1);
  }
}

// All of a scan's usable beams or none, so equal instants are equal scans.
void expect_same_instants(const OffsetMap& l, const OffsetMap& r) {
  ASSERT_EQ(l.cloud->size(), r.cloud->size());
  for (std::size_t i = 0; i < l.cloud->size(); i += 37)
    ASSERT_EQ(l.cloud->points[i].time_s, r.cloud->points[i].time_s);
}

TEST_F(StandingInTheHall, EveryOffsetsMapHoldsTheSameScans) {
  expect_same_instants(maps_[0], maps_[1]);
}

TEST_F(StandingInTheHall, PointsAreInTheOrderOfTimeAndNeighbouringSweepsAlternate) {
  const auto& points = maps_[0].cloud->points;
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end(),
                             [](const MapPoint& a, const MapPoint& b) { return a.time_s < b.time_s; }));
  EXPECT_LT(points.front().sweep, points.back().sweep);
}

class WalkingThroughAStation : public testing::Test {
 protected:
  const Simulation& simulation_ = test::simulated("metro-station", kMapTruth_s, 12);
  const std::vector<OffsetMap> maps_ = maps_of(simulation_.recording, {kMapTruth_s, kMapTruth_s + 5 * kMs});
};

TEST_F(WalkingThroughAStation, TheTrajectoryAscendsInTimeAndFollowsTheWalk) {
  const auto& trajectory = maps_[0].trajectory;
  EXPECT_TRUE(maps_[0].moving);
  EXPECT_FALSE(maps_[0].lost);
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    EXPECT_GT(trajectory[i].time_s, trajectory[i - 1].time_s);
  // The last sweep, of which only a part was recorded, goes on beyond the truth.
  const StampedPose &first = trajectory[2], &last = trajectory[trajectory.size() - 3];
  const auto truth_at = [&](double t_s) { return simulation_.truth.at(std::size_t(t_s / 0.01)).position_m; };
  const double truth_m = (truth_at(last.time_s) - truth_at(first.time_s)).norm();
  const double found_m = (last.position_m - first.position_m).norm();
  EXPECT_GT(truth_m, 3);
  EXPECT_NEAR(found_m, truth_m, 0.15);
}

TEST_F(WalkingThroughAStation, TheTrajectoryIsTheSameAtEveryOffset) {
  const auto &truth = maps_[0].sweeps, &off = maps_[1].sweeps;
  ASSERT_EQ(truth.size(), off.size());
  for (std::size_t k = 0; k < truth.size(); ++k)
    EXPECT_EQ(truth[k].end().translation_m, off[k].end().translation_m) << k;
}

TEST_F(WalkingThroughAStation, EveryOffsetsMapHoldsTheSameScans) {
  expect_same_instants(maps_[0], maps_[1]);
}

/// Poses of a rig that stands still, from and to those times.
MapOptions placed_by_poses(double from_s, double to_s) {
  MapOptions options;
  options.poses = {{from_s, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()},
                   {to_s, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()}};
  return options;
}

TEST_F(StandingInTheHall, PosesOfAnotherTimeAreRefusedWithBothSpans) {
  const std::vector<double> offsets_s = {kMapTruth_s};
  const double end_s = recording_.scans.back().last_beam_s();
  for (const double from_s : {-1000.0, end_s + 1}) {
    const auto maps = build_maps(recording_, offsets_s, placed_by_poses(from_s, from_s + 0.5), Job());
    ASSERT_FALSE(maps);
    EXPECT_EQ(maps.error().code, ExitCode::kNotIdentifiable);
    EXPECT_NE(maps.error().message.find("no scan lies within the time of the poses: the poses are from"),
              std::string::npos)
        << maps.error().message;
  }
}

TEST_F(StandingInTheHall, PosesOfAPartOfTheTimeLeaveScansOutWithAWarning) {
  const std::vector<double> offsets_s = {kMapTruth_s};
  const double end_s = recording_.scans.back().last_beam_s();
  const auto whole = build_maps(recording_, offsets_s, placed_by_poses(-1, end_s + 1), Job());
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->front().warning, "");
  const auto part = build_maps(recording_, offsets_s, placed_by_poses(-1, end_s / 2), Job());
  ASSERT_TRUE(part);
  EXPECT_NE(part->front().warning.find("scans lie outside the time of the poses, from "), std::string::npos)
      << part->front().warning;
  EXPECT_LT(part->front().cloud->size(), whole->front().cloud->size());
}

TEST(OffsetMap, AnotherKindOfRecordingCanBeAssumed) {
  MapOptions options;
  options.assume = RigKind::kStationary;
  const std::vector<double> offsets_s = {kMapTruth_s};
  const auto maps =
      build_maps(test::simulated("metro-station", kMapTruth_s, 4).recording, offsets_s, options, Job());
  ASSERT_TRUE(maps);
  EXPECT_FALSE(maps->front().moving);
}

TEST(OffsetMap, AMotorThatIsStuckIsNotIdentifiable) {
  SimulationOptions options;
  options.motor = simulation::MotorKind::kStuck;
  options.duration_s = 1;
  const std::vector<double> offsets_s = {0.0};
  const auto maps = build_maps(simulate(options, Job()).value().recording, offsets_s, MapOptions(), Job());
  ASSERT_FALSE(maps);
  EXPECT_EQ(maps.error().code, ExitCode::kNotIdentifiable);
}

}  // namespace
}  // namespace sweepscope
