#include "core/map/place_beams.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "core/map/offset_map.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kPlacedAt_s = 0.024;
const std::vector<double> kOffsets_s{19 * kMs, 21 * kMs, 24 * kMs};
using Places = std::vector<std::array<float, 3>>;

MapOptions assumed(RigKind kind) {
  MapOptions options;
  options.assume = kind;
  return options;
}

struct Placed {
  Placed(const Recording& recording, const MapOptions& options)
      : prepared(prepare(recording, {}, Job()).value()),
        beams(collect_beams(recording)),
        path(find_map_path(prepared, kOffsets_s.front(), kOffsets_s.back(), options, Job()).value()) {}
  std::vector<OffsetMap> maps() const {
    MapOptions same = assumed(path.moving ? RigKind::kMoving : RigKind::kStationary);
    same.poses = path.poses;
    same.walk = path.walk;
    return build_maps(prepared, kOffsets_s, same, Job()).value();
  }
  Places at(double offset_s) const { return place_beams(beams, path, offset_s); }
  PreparedRecording prepared;
  Beams beams;
  MapPath path;
};

const Placed& walk() {
  static const Placed placed(test::simulated("metro-station", kPlacedAt_s, 6).recording,
                             assumed(RigKind::kMoving));
  return placed;
}

const Placed& stationary() {
  static const Placed placed(test::room(kPlacedAt_s), assumed(RigKind::kStationary));
  return placed;
}

Placed along_poses() {
  const Simulation& simulation = test::simulated("metro-station", kPlacedAt_s, 6);
  MapOptions options;
  for (const TruthPose& pose : simulation.truth)
    options.poses.push_back({pose.time_s, pose.position_m, pose.orientation});
  return Placed(simulation.recording, options);
}

// The explorer places what a drag shows, `map` and `compare` build maps: the same beams, to the byte.
void expect_the_maps(const Placed& placed) {
  for (const OffsetMap& map : placed.maps()) {
    const Places places_m = placed.at(map.offset_s);
    std::size_t next = 0;
    for (std::size_t i = 0; i < places_m.size(); ++i) {
      if (std::isnan(places_m[i][0])) continue;
      ASSERT_LT(next, map.cloud->size());
      const MapPoint& point = map.cloud->points[next++];
      ASSERT_EQ(placed.beams.time_s(i), point.time_s);
      ASSERT_EQ(places_m[i], (std::array{point.x, point.y, point.z})) << map.offset_s;
    }
    EXPECT_EQ(next, map.cloud->size());
    EXPECT_GT(next, placed.beams.size() * 9 / 10);
  }
}

TEST(PlaceBeams, AtEveryOffsetTheyAreTheMapOfAWalk) {
  expect_the_maps(walk());
}

TEST(PlaceBeams, AtEveryOffsetTheyAreTheMapOfAStationaryRig) {
  expect_the_maps(stationary());
}

TEST(PlaceBeams, AtEveryOffsetTheyAreTheMapAlongPosesFromElsewhere) {
  expect_the_maps(along_poses());
}

TEST(PlaceBeams, NearAReversalAScanGoesOverToTheNextSweep) {
  const Recording& recording = *walk().prepared.recording;
  const ScanPoses before(recording, walk().path, 0), after(recording, walk().path, 40 * kMs);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    if (before.pose_of(i) == ScanPoses::kNone || after.pose_of(i) == ScanPoses::kNone) continue;
    EXPECT_GE(after.pose_of(i), before.pose_of(i));
    moved += after.pose_of(i) != before.pose_of(i) ? 1 : 0;
  }
  EXPECT_GT(moved, 0U);
  EXPECT_LT(moved, recording.scans.size() / 4);
}

TEST(PlaceBeams, OfAMotorThatDoesNotTurnAllScansBelongToOneSweep) {
  Recording recording = test::room(kPlacedAt_s);
  for (double& angle_rad : recording.motor.angle_rad) angle_rad = 0.5;
  const PreparedRecording prepared = prepare(recording, {}, Job()).value();
  ASSERT_TRUE(prepared.motor.sweeps.empty());
  const MapPath path = path_without_solving(prepared, std::vector<char>(recording.scans.size(), 1));
  for (const auto& p_m : place_beams(collect_beams(recording), path, kPlacedAt_s))
    ASSERT_TRUE(std::isfinite(p_m[0]));
}

TEST(PlaceBeams, AnotherOffsetTurnsABeamAboutTheMotorsAxisByItsSpeed) {
  const Recording& recording = *stationary().prepared.recording;
  const Beams& beams = stationary().beams;
  const Places before = stationary().at(kPlacedAt_s - 2 * kMs), after = stationary().at(kPlacedAt_s);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < beams.size(); i += 997) {
    if (std::isnan(before[i][0]) || std::isnan(after[i][0])) continue;
    ++compared;
    const double t_s = beams.time_s(i) + kPlacedAt_s;
    const double turn_rad = recording.motor.angle_at(t_s) - recording.motor.angle_at(t_s - 2 * kMs);
    const Eigen::Vector2d p(before[i][1], before[i][2]);
    const Eigen::Vector2d q = Eigen::Rotation2Dd(turn_rad) * p;
    EXPECT_NEAR(q.x(), after[i][1], 1e-5);
    EXPECT_NEAR(q.y(), after[i][2], 1e-5);
    EXPECT_NEAR(before[i][0], after[i][0], 1e-6);
  }
  EXPECT_GT(compared, 50U);
}

TEST(PlaceBeams, ChosenBeamsAreWhereAllOfThemPutThem) {
  const Places all = walk().at(0.021);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 5; i < all.size(); i += 31) chosen.push_back(i);
  const Places some = place_beams(walk().beams, walk().path, 0.021, chosen);
  ASSERT_EQ(some.size(), chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k)
    ASSERT_EQ(std::memcmp(&some[k], &all[chosen[k]], sizeof some[k]), 0);
}

TEST(PlaceBeams, OneThreadGivesTheSameBytesAsMany) {
  const Places many = walk().at(0.02);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Places single = walk().at(0.02);
  EXPECT_EQ(std::memcmp(many.data(), single.data(), many.size() * sizeof many[0]), 0);
}

TEST(Beams, ABeamNamesItsScanAndRange) {
  const Recording& recording = test::room(kPlacedAt_s);
  const Beams beams = collect_beams(recording);
  const std::size_t point = beams.size() / 2, scan = beams.scan[point];
  EXPECT_LE(beams.first_point[scan], point);
  EXPECT_GT(beams.first_point[scan + 1], point);
  EXPECT_EQ(beams.range_m(point), recording.ranges(recording.scans[scan])[beams.beam[point]]);
  EXPECT_TRUE(std::isfinite(beams.range_m(point)));
}

TEST(Beams, OfUsedScansEveryNthIsTakenInTheirOrder) {
  const Recording& recording = test::room(kPlacedAt_s);
  std::vector<char> used(recording.scans.size(), 1);
  used[3] = 0;
  const Beams all = collect_beams(recording), third = collect_beams(recording, used, 3);
  EXPECT_EQ(third.first_point[3], third.first_point[4]);
  const std::size_t left_out = usable_beams(recording, recording.scans[3]);
  EXPECT_EQ(third.size(), (all.size() - left_out + 2) / 3);
  for (std::size_t k = 0; 3 * k < all.first_point[3]; ++k) {
    EXPECT_EQ(third.scan[k], all.scan[3 * k]);
    EXPECT_EQ(third.beam[k], all.beam[3 * k]);
  }
}

}  // namespace
}  // namespace sweepscope
