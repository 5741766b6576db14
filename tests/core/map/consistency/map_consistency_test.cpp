#include "core/map/consistency/map_consistency.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/loam/path/agreement.hpp"
#include "core/loam/path/given_motion.hpp"
#include "core/map/map_path.hpp"
#include "core/results/consistency_json.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kMs;

constexpr double kWalkTruth_s = 0.024;
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

MapPath path_along(const Simulation& walk, const Error& error, double offset_s = kWalkTruth_s) {
  const auto prepared = prepare(walk.recording, {}, Job()).value();
  MapOptions options;
  options.poses = poses_with(walk, error);
  return find_map_path(prepared, offset_s, offset_s, options, Job()).value();
}

const Simulation& consistent_walk() {
  return test::simulated("metro-station", kWalkTruth_s, 20);
}

TEST(MapConsistency, OfATrueTrajectorySurfacesCoincide) {
  const MapPath path = path_along(consistent_walk(), no_error);
  ASSERT_TRUE(path.consistency && path.consistency->worst());
  EXPECT_LT(path.consistency->worst()->apart_m, 0.06);
  EXPECT_FALSE(path.consistency->warned()) << path.warning;
  EXPECT_EQ(path.warning, "");
}

TEST(MapConsistency, AStepIsFoundWithItsSizeItsTimeAndAPlace) {
  constexpr double kStep_m = 0.6, kAt_s = 10.3;
  const MapPath path =
      path_along(consistent_walk(), [](double t_s) { return Vector3d(0, t_s < kAt_s ? 0 : kStep_m, 0); });
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
  const std::vector<StampedPose> true_poses = poses_with(consistent_walk(), no_error);
  const double first_s = consistent_walk().recording.scans.front().first_beam_s;
  const auto true_at = [&](double t_s) {
    const auto after = std::ranges::lower_bound(true_poses, t_s + first_s, {}, &StampedPose::time_s);
    return (after == true_poses.end() ? true_poses.back() : *after).position_m;
  };
  const MapPath path = path_along(consistent_walk(), [&](double t_s) {
    return Vector3d(true_at(9) - true_at(std::clamp(t_s, 9.0, 11.0)));
  });
  ASSERT_TRUE(path.consistency);
  EXPECT_TRUE(path.consistency->warned());
}

TEST(MapConsistency, AWrongOffsetIsNotABrokenTrajectory) {
  for (const double wrong_s : {-5 * kMs, 5 * kMs}) {
    const MapPath path = path_along(consistent_walk(), no_error, kWalkTruth_s + wrong_s);
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
  const auto prepared = prepare(consistent_walk().recording, {}, Job()).value();
  MapOptions options;
  options.poses = poses_with(consistent_walk(), no_error);
  const double first_s = options.poses.front().time_s;
  std::erase_if(options.poses, [&](const StampedPose& pose) { return pose.time_s > first_s + 3; });
  const MapPath path = find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, options, Job()).value();
  ASSERT_TRUE(path.consistency);
  EXPECT_FALSE(path.consistency->worst());
  EXPECT_EQ(consistency_json(path.consistency.get())["worst_m"], nullptr);
}

// A walk whose trajectory makes a step of its own is tracked again, and given back once it agrees with
// itself.
TEST(MapConsistency, AWalkThatDoesNotAgreeWithItselfIsTrackedInAnotherWay) {
  const auto prepared = prepare(consistent_walk().recording, {}, Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  const MapPath good = find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, options, Job()).value();
  ASSERT_EQ(good.warning, "");
  EXPECT_FALSE(good.walk->tracked_again);
  SolvedWalk broken = *good.walk;
  for (std::size_t i = broken.sweeps.size() / 2; i < broken.sweeps.size(); ++i)
    for (Pose& knot : broken.sweeps[i].knots) knot.translation_m.y() += 0.6;
  options.walk = std::make_shared<const SolvedWalk>(std::move(broken));
  const MapPath again = find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, options, Job()).value();
  EXPECT_EQ(again.warning, "");
  EXPECT_TRUE(again.walk->tracked_again);
  // The first and the last sweep were recorded in part.
  const auto way_m = [](const MapPath& path) {
    const std::vector<SweepPose>& sweeps = path.walk->sweeps;
    return (sweeps[1].begin().inverse() * sweeps.rbegin()[1].begin()).translation_m;
  };
  EXPECT_LT((way_m(again) - way_m(good)).norm(), 0.1);
}

TEST(MapConsistency, AWalkWhoseTracksContradictEachOtherIsTrackedInAnotherWayAndWarnedOf) {
  const auto prepared = prepare(consistent_walk().recording, {}, Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  SolvedWalk doubtful = *find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, options, Job()).value().walk;
  doubtful.contradiction = in_words(Contradiction{4, 7, 3.0}, 0);
  options.walk = std::make_shared<const SolvedWalk>(doubtful);
  const MapPath again = find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, options, Job()).value();
  EXPECT_TRUE(again.walk->tracked_again);
  EXPECT_EQ(again.warning, "");

  doubtful.tracked_again = true;
  options.walk = std::make_shared<const SolvedWalk>(doubtful);
  const MapPath kept = find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, options, Job()).value();
  EXPECT_TRUE(kept.consistency->warned());
  EXPECT_NE(kept.warning.find("From 4 to 7 s"), std::string::npos) << kept.warning;
  EXPECT_NE(kept.warning.find("it ends 3.0 m apart"), std::string::npos) << kept.warning;
}

// A walk of 9 s along a tube without end or mark, and where the rig was.
constexpr double kTubeWalk_s = 9, kTubeSpeed_mps = 0.8;

Recording walk_along_a_tube() {
  test::Bench bench;
  bench.mesh = simulation::box({-80, -1.2, -1.5}, {80, 1.2, 1.2});
  bench.duration_s = kTubeWalk_s;
  bench.noise_m = 0.01;
  bench.world_from_base = [](double t_s) {
    return Eigen::Isometry3d(Eigen::Translation3d(kTubeSpeed_mps * t_s, 0, 0));
  };
  return bench.record();
}

std::vector<StampedPose> poses_along_the_tube() {
  std::vector<StampedPose> poses;
  for (double t_s = -1; t_s < kTubeWalk_s + 1; t_s += 0.1)
    poses.push_back({t_s, {kTubeSpeed_mps * t_s, 0, 0}, Eigen::Quaterniond::Identity()});
  return poses;
}

SolvedWalk solved_along_the_tube(const PreparedRecording& prepared) {
  const GivenMotion given(poses_along_the_tube(), GivenMotion::Parts::kRotationAndTranslation,
                          GivenMotion::Role::kTruth);
  SolvedWalk walk;
  for (std::size_t i = 0; i < prepared.motor.sweeps.size(); ++i) {
    const Sweep& sweep = prepared.motor.sweeps[i];
    SweepPose pose;
    pose.sweep = i;
    pose.direction = sweep.direction;
    pose.begin_s = sweep.begin_s;
    pose.end_s = sweep.end_s;
    walk.sweeps.push_back(along(given, pose, given.at(pose.begin_s), pose.begin_s, MappingOptions().knot_s));
  }
  return walk;
}

MapPath path_along_the_tube(const PreparedRecording& prepared, SolvedWalk walk) {
  MapOptions options;
  options.walk = std::make_shared<const SolvedWalk>(std::move(walk));
  return find_map_path(prepared, 0, 0, options, Job()).value();
}

TEST(MapConsistency, AWalkWhoseMotionNothingShowsIsWarnedOf) {
  const Recording recording = walk_along_a_tube();
  const auto prepared = prepare(recording, {}, Job()).value();
  const MapPath path = path_along_the_tube(prepared, solved_along_the_tube(prepared));
  ASSERT_TRUE(path.consistency);
  ASSERT_EQ(path.consistency->drifting.size(), 1u);
  EXPECT_GT(path.consistency->drifting.front().direction.x(), 0.99);
  EXPECT_TRUE(path.consistency->warned());
  EXPECT_TRUE(path.consistency->agrees_with_itself());
  EXPECT_FALSE(path.walk->tracked_again) << "no other track could show it";
  EXPECT_NE(path.warning.find("nothing in view shows how far the rig moved"), std::string::npos)
      << path.warning;
  EXPECT_GT(consistency_json(path.consistency.get())["drifting"][0]["drift_m"], 1);
}

TEST(MapConsistency, AMotionThatAnotherSensorMeasuredIsShown) {
  const Recording recording = walk_along_a_tube();
  const auto prepared = prepare(recording, {}, Job()).value();
  SolvedWalk walk = solved_along_the_tube(prepared);
  walk.joint.emplace().time_shift = TimeShift{};
  EXPECT_EQ(path_along_the_tube(prepared, walk).warning, "");
  MapOptions options;
  options.poses = poses_along_the_tube();
  EXPECT_EQ(find_map_path(prepared, 0, 0, options, Job()).value().warning, "");
}

TEST(MapConsistency, AStationaryRigHasNone) {
  const auto prepared = prepare(test::room(kWalkTruth_s), {}, Job()).value();
  EXPECT_FALSE(find_map_path(prepared, kWalkTruth_s, kWalkTruth_s, {}, Job()).value().consistency);
  EXPECT_EQ(consistency_json(nullptr), nullptr);
}

TEST(MapConsistency, IsTheSameForAnyNumberOfThreads) {
  const auto bent = [](double t_s) { return Vector3d(0.02 * t_s, 0, 0); };
  const auto many = consistency_json(path_along(consistent_walk(), bent).consistency.get()).dump();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(consistency_json(path_along(consistent_walk(), bent).consistency.get()).dump(), many);
}

}  // namespace
}  // namespace sweepscope
