#include "core/simulation/motion/recorded_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/io/trajectory_file.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope::simulation {
namespace {

/// Two metres along x, at 1 m/s, with a camera's axes: x right, y down, z forward, pitched down by 10 deg.
std::vector<StampedPose> camera_walk() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond camera =
      Eigen::Quaterniond(Eigen::AngleAxisd(radians(10), Vector3d::UnitY())) * Eigen::Quaterniond(axes);
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) poses.push_back({100 + i * 0.02, {5 + i * 0.02, 7, 1}, camera});
  return poses;
}

TEST(Placed, LeavesAPathWhereItIsByDefault) {
  const auto poses = camera_walk();
  const auto same = placed(poses, {});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((same[i].position_m - poses[i].position_m).norm(), 1e-12);
    EXPECT_LT(same[i].orientation.angularDistance(poses[i].orientation), 1e-7);
  }
}

TEST(Placed, ScalesTurnsAndMovesAboutTheMean) {
  PathPlacement placement;
  placement.scale = 0.5;
  placement.yaw_deg = 90;
  placement.at_m = Vector3d(1, 2, 3);
  const auto poses = camera_walk();
  const auto moved = placed(poses, placement);
  // 2 m along x become 1 m along y, with its middle at (1, 2, 3).
  EXPECT_LT((moved.front().position_m - Vector3d(1, 1.5, 3)).norm(), 1e-9);
  EXPECT_LT((moved.back().position_m - Vector3d(1, 2.5, 3)).norm(), 1e-9);
  EXPECT_EQ(moved.back().time_s, poses.back().time_s);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitZ()));
  EXPECT_LT(moved[9].orientation.angularDistance(turn * poses[9].orientation), 1e-7);
}

TEST(Placed, UprightTurnsTheRigNotThePath) {
  PathPlacement placement;
  placement.upright = true;
  const auto moved = placed(camera_walk(), placement);
  for (const StampedPose& pose : moved)
    EXPECT_LT(pose.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-7);
  EXPECT_LT((moved.back().position_m - camera_walk().back().position_m).norm(), 1e-12);
}

class ReadPath : public test::FolderTest {
 protected:
  std::string refused(const std::vector<StampedPose>& poses) const {
    EXPECT_TRUE(write_tum(folder_ / "walk.tum", poses));
    const auto path = read_path(folder_ / "walk.tum", {}, 0);
    EXPECT_FALSE(path);
    if (path) return {};
    EXPECT_EQ(path.error().code, ExitCode::kUnreadableInput);
    EXPECT_NE(path.error().message.find("walk.tum: "), std::string::npos);
    return path.error().message;
  }
};

TEST_F(ReadPath, CountsTimeFromTheSecondsLeftOut) {
  ASSERT_TRUE(write_tum(folder_ / "walk.tum", camera_walk()));
  const auto path = read_path(folder_ / "walk.tum", {}, 0.5);
  ASSERT_TRUE(path);
  EXPECT_NEAR(path->duration_s, 1.5, 1e-9);
  EXPECT_LT((path->at(0).position_m - Vector3d(5.5, 7, 1)).norm(), 1e-4);
  EXPECT_LT((path->at(1.25).position_m - Vector3d(6.75, 7, 1)).norm(), 1e-4);
  EXPECT_LT(path->deviation.position_m, 1e-4);
}

TEST_F(ReadPath, RefusesWhatIsNoMotion) {
  const auto poses = camera_walk();
  EXPECT_NE(refused({poses.begin(), poses.begin() + 19}).find("holds 19 poses, but a walk needs at least 20"),
            std::string::npos);
  auto late = poses;
  for (std::size_t i = 50; i < late.size(); ++i) late[i].time_s += 1.5;
  EXPECT_NE(refused(late).find("no pose for 1.520 s after time 100.9800"), std::string::npos);
  auto jump = poses;
  jump[60].orientation = jump[60].orientation * Eigen::Quaterniond(Eigen::AngleAxisd(1.1, Vector3d::UnitX()));
  EXPECT_NE(refused(jump).find("turns by more than 60 deg from one pose to the next at time 101.2000"),
            std::string::npos);
}

}  // namespace
}  // namespace sweepscope::simulation
