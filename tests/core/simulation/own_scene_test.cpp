#include "core/simulation/own_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry/kinematics.hpp"
#include "core/io/content_hash.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/scenes/free_space.hpp"
#include "core/simulation/sensor.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using simulation::RayCaster;
using simulation::Vector3d;

// A room of 12 triangles: x from -4 to 6, y from -3 to 3, z from 0 to 2.8 m.
constexpr const char* kRoom =
    "v -4 -3 0\nv 6 -3 0\nv 6 3 0\nv -4 3 0\nv -4 -3 2.8\nv 6 -3 2.8\nv 6 3 2.8\nv -4 3 2.8\n"
    "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 "
    "5 8\n";

class OwnScenes : public test::FolderTest {
 protected:
  void SetUp() override { std::ofstream(folder_ / "room.obj") << kRoom; }
  SimulationOptions options() const {
    SimulationOptions options;
    options.own.mesh = folder_ / "room.obj";
    options.duration_s = 0.5;
    options.noise_m = 0;
    options.dropout = 0;
    return options;
  }
  /// Swings about the origin in x and turns to and fro.
  void write_walk(double reach_m) const {
    std::vector<StampedPose> poses;
    for (int i = 0; i <= 300; ++i) {
      const double t_s = 0.02 * i;
      poses.push_back({t_s,
                       {reach_m * std::sin(1.5 * t_s), 0.1 * std::sin(4 * t_s), 0},
                       rotation_from_vector({0.1 * std::sin(5 * t_s), 0, 0.8 * std::sin(t_s)})});
    }
    ASSERT_TRUE(write_tum(folder_ / "walk.tum", poses));
  }
  static Result<Simulation> simulated(const SimulationOptions& options) {
    const Job job;
    return simulate(options, job);
  }
  SimulationOptions walking() const {
    SimulationOptions walk = options();
    walk.own.trajectory = folder_ / "walk.tum";
    walk.own.placement.at_m = Vector3d(0.5, 0, 1.2);
    walk.duration_s.reset();
    return walk;
  }
};

TEST_F(OwnScenes, AStandingRigMeasuresTheRoom) {
  SimulationOptions stand = options();
  stand.own.placement.at_m = Vector3d(1, 0.5, 1);
  const auto ahead = simulated(stand);
  ASSERT_TRUE(ahead) << ahead.error().message;
  EXPECT_EQ(ahead->triangles, 12U);
  EXPECT_FALSE(ahead->moving);
  // The forward beam is the motor's axis: 5 m to the wall at x = 6, and 2.5 m to that at y = 3 when turned
  // left.
  for (std::size_t scan = 0; scan < 20; ++scan)
    EXPECT_FLOAT_EQ(ahead->recording.ranges_m[scan * simulation::Scanner{}.beams + 360], 5.0F);
  stand.own.placement.yaw_deg = 90;
  EXPECT_FLOAT_EQ(simulated(stand)->recording.ranges_m[360], 2.5F);
}

// Each point, placed with the true pose, the true offset and the motor's track, lies on a wall.
TEST_F(OwnScenes, PointsOfAWalkLieOnTheWallsAtTheTruth) {
  write_walk(1.5);
  SimulationOptions walk = walking();
  walk.encoder_step_deg = 1e-4;
  walk.encoder_jitter_s = 0;
  walk.encoder_hz = 2000;
  const auto made = simulated(walk);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->moving);
  EXPECT_NEAR(*made->options.duration_s, 6, 1e-6);
  EXPECT_NEAR(made->truth[1].time_s, 0.005, 1e-12);  // 200 Hz
  EXPECT_LT(made->deviation.position_m, 1e-3);
  const Recording& recording = made->recording;
  const Kinematics kinematics{Rig::Mount{}};
  double worst_m = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    for (std::size_t beam = 0; beam < scan.beams; beam += 7) {
      const double t_s = scan.first_beam_s + static_cast<double>(beam) * scan.time_increment_s;
      const auto before = static_cast<std::size_t>(t_s / 0.005);
      const TruthPose &from = made->truth[before], &to = made->truth[before + 1];
      const double u = t_s / 0.005 - static_cast<double>(before);
      const Vector3d in_base = kinematics.base_from_motor(
          kinematics.point_in_motor(recording.ranges_m[scan.first_range + beam],
                                    scan.beam_angle_rad(static_cast<double>(beam))),
          recording.motor.angle_at(t_s + walk.offset_s));
      const Vector3d p = from.position_m + u * (to.position_m - from.position_m) +
                         from.orientation.slerp(u, to.orientation) * in_base;
      worst_m = std::max(worst_m, std::min({std::abs(p.x() + 4), std::abs(p.x() - 6), std::abs(p.y() + 3),
                                            std::abs(p.y() - 3), std::abs(p.z()), std::abs(p.z() - 2.8)}));
    }
  }
  EXPECT_LT(worst_m, 1.5e-3);  // ranges are whole millimetres
}

TEST_F(OwnScenes, AWalkThatComesTooNearIsRefusedWithTimeAndPlace) {
  write_walk(1.5);
  SimulationOptions walk = walking();
  walk.own.placement.at_m = Vector3d(4.7, 0, 1.2);  // 1.18 m further is 0.12 m from the wall at x = 6
  const auto near = simulated(walk);
  ASSERT_FALSE(near);
  EXPECT_EQ(near.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(near.error().message.find("room.obj: 0.9"), std::string::npos) << near.error().message;
  EXPECT_NE(near.error().message.find("m from a surface, nearer than 0.15 m"), std::string::npos);
  walk.own.placement.at_m = Vector3d(4.6, 0, 1.2);
  EXPECT_TRUE(simulated(walk));
  walk.own.placement.scale = 2;  // through the wall
  EXPECT_FALSE(simulated(walk));
}

TEST_F(OwnScenes, AJumpThroughAWallIsSeen) {
  const RayCaster wall(simulation::box({0, -9, -9}, {0.01, 9, 9}));
  const auto jump = [](double t_s) { return Vector3d(t_s < 0.5 ? -1.0 : 1.0, 0, 0); };
  const auto checked = simulation::check_free_space(wall, jump, 1);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("0.50 s after its start"), std::string::npos)
      << checked.error().message;
  EXPECT_NE(checked.error().message.find("has passed through a surface"), std::string::npos);
  EXPECT_TRUE(simulation::check_free_space(wall, jump, 0.49));
}

TEST_F(OwnScenes, TheTruthNamesTheFilesAndTheirContents) {
  write_walk(1);
  SimulationOptions walk = walking();
  walk.own.placement.scale = 0.5;
  walk.mount_error_deg = {1, 2, 3};
  walk.mount_error_m = {0.01, 0.02, 0.03};
  walk.duration_s = 1;
  const auto made = simulated(walk);
  ASSERT_TRUE(made) << made.error().message;
  const std::string text = truth_json(*made);
  EXPECT_EQ(text.find(folder_.string()), std::string::npos);
  const auto truth = nlohmann::json::parse(text);
  EXPECT_EQ(truth["own_scene"]["mesh"], "room.obj");
  EXPECT_EQ(truth["own_scene"]["mesh_hash"], content_hash(kRoom));
  EXPECT_EQ(truth["own_scene"]["trajectory"], "walk.tum");
  EXPECT_EQ(truth["own_scene"]["trajectory_hash"], *file_content_hash(folder_ / "walk.tum"));
  EXPECT_EQ(truth["own_scene"]["scale"], 0.5);
  EXPECT_EQ(truth["laser_in_motor"]["rpy_deg"], nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(truth["laser_in_motor"]["xyz_m"], nlohmann::json({0.01, 0.02, 0.03}));
  EXPECT_EQ(made->truth.size(), 201U);
}

TEST_F(OwnScenes, ACutWalkIsTheBeginningOfTheWholeOne) {
  write_walk(1);
  SimulationOptions walk = walking();
  walk.duration_s = 2;
  const auto whole = simulated(walk);
  walk.duration_s = 1;
  const auto part = simulated(walk);
  ASSERT_TRUE(whole && part);
  EXPECT_TRUE(std::equal(part->recording.ranges_m.begin(), part->recording.ranges_m.end(),
                         whole->recording.ranges_m.begin()));
}

TEST_F(OwnScenes, ATrajectoryIsNotLongerThanItIs) {
  write_walk(1);
  SimulationOptions walk = walking();
  walk.own.from_s = 4;
  EXPECT_NEAR(*simulated(walk)->options.duration_s, 2, 1e-6);
  walk.duration_s = 3;
  EXPECT_NE(simulated(walk).error().message.find("room.obj can be recorded for 0.1 to 2 s"),
            std::string::npos);
  walk.duration_s.reset();
  walk.own.from_s = 7;
  EXPECT_FALSE(simulated(walk));
}

}  // namespace
}  // namespace sweepscope
