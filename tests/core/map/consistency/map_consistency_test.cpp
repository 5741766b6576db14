#include "core/map/consistency/map_consistency.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/map/map_path.hpp"
#include "core/results/consistency_json.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kMs;

constexpr double kTruth_s = 0.024;
// How a trajectory is wrong at a time since the first scan.
using Error = std::function<Vector3d(double)>;

Vector3d no_error(double) {
  return Vector3d::Zero();
}

std::vector<StampedPose> poses_with(const Simulation& walk, const Error& error) {
  std::vector<StampedPose> poses;
  const double first_s = walk.recording.scans.front().first_beam_s;
  for (const TruthPose& pose : walk.truth)
    poses.push_back({pose.time_s, pose.position_m + error(pose.time_s - first_s), pose.orientation});
  return poses;
}

MapPath path_along(const Simulation& walk, const Error& error, double offset_s = kTruth_s) {
  const auto prepared = prepare(walk.recording, {}, Job()).value();
  MapOptions options;
  options.poses = poses_with(walk, error);
  return find_map_path(prepared, offset_s, offset_s, options, Job()).value();
}

const Simulation& walk() {
  return test::simulated("metro-station", kTruth_s, 20);
}

TEST(MapConsistency, OfATrueTrajectorySurfacesCoincide) {
  const MapPath path = path_along(walk(), no_error);
  ASSERT_TRUE(path.consistency && path.consistency->worst());
  EXPECT_LT(path.consistency->worst()->apart_m, 0.06);
  EXPECT_FALSE(path.consistency->warned()) << path.warning;
  EXPECT_EQ(path.warning, "");
}

TEST(MapConsistency, AStepIsFoundWithItsSizeItsTimeAndAPlace) {
  constexpr double kStep_m = 0.6, kAt_s = 10.3;
  const MapPath path =
      path_along(walk(), [](double t_s) { return Vector3d(0, t_s < kAt_s ? 0 : kStep_m, 0); });
  ASSERT_TRUE(path.consistency && path.consistency->worst());
  const SurfacesApart worst = *path.consistency->worst();
  EXPECT_NEAR(worst.apart_m, kStep_m, 0.15);
  EXPECT_LT(worst.first_s, kAt_s + 1);
  EXPECT_GT(worst.again_s, kAt_s - 1);
  EXPECT_TRUE(path.consistency->warned());
  EXPECT_NE(path.warning.find("The map does not agree with itself"), std::string::npos) << path.warning;
  EXPECT_NE(path.warning.find(" m apart near ("), std::string::npos) << path.warning;
  double first_s = 0, again_s = 0;
  const auto times = path.warning.find("seen at ");
  ASSERT_EQ(std::sscanf(path.warning.c_str() + times, "seen at %lf s and again at %lf s", &first_s, &again_s),
            2);
  EXPECT_NEAR(first_s, kAt_s, 5);
  EXPECT_NEAR(again_s, kAt_s, 5);
}

// What a tracker does that takes the rig to be at rest for two seconds: the map is scaled there.
TEST(MapConsistency, ATrajectoryThatStandsStillForTwoSecondsIsFound) {
  const std::vector<StampedPose> true_poses = poses_with(walk(), no_error);
  const double first_s = walk().recording.scans.front().first_beam_s;
  const auto true_at = [&](double t_s) {
    const auto after = std::ranges::lower_bound(true_poses, t_s + first_s, {}, &StampedPose::time_s);
    return (after == true_poses.end() ? true_poses.back() : *after).position_m;
  };
  const MapPath path = path_along(
      walk(), [&](double t_s) { return Vector3d(true_at(9) - true_at(std::clamp(t_s, 9.0, 11.0))); });
  ASSERT_TRUE(path.consistency);
  EXPECT_TRUE(path.consistency->warned());
}

TEST(MapConsistency, AWrongOffsetIsNotABrokenTrajectory) {
  for (const double wrong_s : {-5 * kMs, 5 * kMs}) {
    const MapPath path = path_along(walk(), no_error, kTruth_s + wrong_s);
    ASSERT_TRUE(path.consistency);
    EXPECT_FALSE(path.consistency->warned()) << path.warning;
  }
}

TEST(MapConsistency, PeopleWhoWalkThroughTheSceneAreNotABrokenTrajectory) {
  SimulationOptions options;
  options.scene = "metro-station";
  options.duration_s = 20;
  options.people = 4;
  const Simulation crowded = simulate(options, Job()).value();
  const MapPath path = path_along(crowded, no_error);
  ASSERT_TRUE(path.consistency);
  EXPECT_FALSE(path.consistency->warned()) << path.warning;
}

TEST(MapConsistency, IsNotDeterminedWhereNoSurfaceWasSeenTwice) {
  const auto prepared = prepare(walk().recording, {}, Job()).value();
  MapOptions options;
  options.poses = poses_with(walk(), no_error);
  const double first_s = options.poses.front().time_s;
  std::erase_if(options.poses, [&](const StampedPose& pose) { return pose.time_s > first_s + 3; });
  const MapPath path = find_map_path(prepared, kTruth_s, kTruth_s, options, Job()).value();
  ASSERT_TRUE(path.consistency);
  EXPECT_FALSE(path.consistency->worst());
  EXPECT_EQ(consistency_json(path.consistency.get())["worst_m"], nullptr);
}

// A walk whose trajectory makes a step of its own is tracked again, and given back once it agrees with
// itself.
TEST(MapConsistency, AWalkThatDoesNotAgreeWithItselfIsTrackedInAnotherWay) {
  const auto prepared = prepare(walk().recording, {}, Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  const MapPath good = find_map_path(prepared, kTruth_s, kTruth_s, options, Job()).value();
  ASSERT_EQ(good.warning, "");
  EXPECT_FALSE(good.walk->tracked_again);
  SolvedWalk broken = *good.walk;
  for (std::size_t i = broken.sweeps.size() / 2; i < broken.sweeps.size(); ++i)
    for (Pose& knot : broken.sweeps[i].knots) knot.translation_m.y() += 0.6;
  options.walk = std::make_shared<const SolvedWalk>(std::move(broken));
  const MapPath again = find_map_path(prepared, kTruth_s, kTruth_s, options, Job()).value();
  EXPECT_EQ(again.warning, "");
  EXPECT_TRUE(again.walk->tracked_again);
  // The last sweep was recorded in part.
  const auto late_m = [](const MapPath& path) { return path.walk->sweeps.rbegin()[1].begin().translation_m; };
  EXPECT_LT((late_m(again) - late_m(good)).norm(), 0.1);
}

constexpr double kTurn_rad = -0.9, kTurnsAt_s = 8.3, kTurns_s = 0.25;

double heading_rad(double t_s) {
  const double part = std::clamp((t_s - kTurnsAt_s) / kTurns_s, 0.0, 1.0);
  return kTurn_rad * (part - std::sin(2 * test::kPi * part) / (2 * test::kPi));
}

// Carried in a circle through a hall, and turned within a quarter of a second.
test::Bench turning_rig() {
  test::Bench bench;
  bench.mesh = test::hall();
  bench.duration_s = 14;
  bench.sweep_s = 0.507;
  bench.offset_s = kTruth_s;
  bench.noise_m = 0.01;
  bench.world_from_base = [](double t_s) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Vector3d(std::sin(0.5 * t_s), 0.1 - 0.6 * std::cos(0.5 * t_s), 0);
    pose.rotate(Eigen::AngleAxisd(heading_rad(t_s), Vector3d::UnitZ()));
    return pose;
  };
  return bench;
}

TEST(MapConsistency, ATurnThatTheTrajectoryMissesIsFound) {
  const test::Bench bench = turning_rig();
  const Recording recording = bench.record();
  MapOptions options;
  const double first_s = recording.scans.front().first_beam_s;
  const Vector3d about_m = bench.world_from_base(kTurnsAt_s).translation();
  for (double t_s = -0.1; t_s < bench.duration_s + 0.1; t_s += 0.02) {
    const Eigen::AngleAxisd back(-heading_rad(t_s), Vector3d::UnitZ());
    const Eigen::Isometry3d pose = bench.world_from_base(t_s);
    options.poses.push_back({first_s + t_s, about_m + back * (pose.translation() - about_m),
                             Eigen::Quaterniond(back * pose.rotation())});
  }
  const auto prepared = prepare(recording, {}, Job()).value();
  const MapPath path = find_map_path(prepared, kTruth_s, kTruth_s, options, Job()).value();
  ASSERT_TRUE(path.consistency);
  ASSERT_FALSE(path.consistency->missed_turns.empty());
  EXPECT_NEAR(path.consistency->missed_turns.front().turned_rad, -kTurn_rad, 0.1);
  EXPECT_NE(path.warning.find("fits much better if the rig turned by "), std::string::npos) << path.warning;
}

// The sweeps after the turn match each other as well as those before it.
TEST(MapConsistency, ATurnThatTheFirstTrackMissesIsFollowedByAnother) {
  const Recording recording = turning_rig().record();
  const auto prepared = prepare(recording, {}, Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  const MapPath path = find_map_path(prepared, kTruth_s, kTruth_s, options, Job()).value();
  ASSERT_TRUE(path.walk);
  EXPECT_TRUE(path.walk->tracked_again);
  const std::vector<SweepPose>& sweeps = path.walk->sweeps;
  const SweepPose &early = sweeps[2], &late = sweeps.rbegin()[2];
  const Vector3d turned_rad = turn_between(early.middle().rotation, late.middle().rotation);
  EXPECT_NEAR(turned_rad.norm(), -kTurn_rad, 0.05);
}

TEST(MapConsistency, AStationaryRigHasNone) {
  const auto prepared = prepare(test::room(kTruth_s), {}, Job()).value();
  EXPECT_FALSE(find_map_path(prepared, kTruth_s, kTruth_s, {}, Job()).value().consistency);
  EXPECT_EQ(consistency_json(nullptr), nullptr);
}

TEST(MapConsistency, IsTheSameForAnyNumberOfThreads) {
  const auto bent = [](double t_s) { return Vector3d(0.02 * t_s, 0, 0); };
  const auto many = consistency_json(path_along(walk(), bent).consistency.get()).dump();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(consistency_json(path_along(walk(), bent).consistency.get()).dump(), many);
}

}  // namespace
}  // namespace sweepscope
