#include "core/io/trajectory_file.hpp"

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using TrajectoryFileTest = test::FolderTest;

TEST_F(TrajectoryFileTest, WritesTumLinesWithTheQuaternionsRealPartLast) {
  const auto path = folder_ / "t.tum";
  const StampedPose pose{
      1.5, {1, -2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()))};
  ASSERT_TRUE(write_tum(path, std::array{pose}));
  EXPECT_EQ(test::contents_of(path),
            "# time_s x_m y_m z_m qx qy qz qw\n"
            "1.500000000 1.000000000 -2.000000000 3.000000000 1.000000000000 0.000000000000 0.000000000000 "
            "0.000000000000\n");
}

TEST_F(TrajectoryFileTest, ReadsBackWhatItWrote) {
  const auto path = folder_ / "t.tum";
  const std::vector<StampedPose> written{{0.1, {1, 2, 3}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5)},
                                         {0.2, {4, 5, 6}, {1, 0, 0, 0}}};
  ASSERT_TRUE(write_tum(path, written));
  const auto read = read_tum(path);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2U);
  EXPECT_DOUBLE_EQ((*read)[0].time_s, 0.1);
  EXPECT_TRUE((*read)[0].position_m.isApprox(written[0].position_m));
  EXPECT_TRUE((*read)[0].orientation.isApprox(written[0].orientation));
}

TEST_F(TrajectoryFileTest, ErrorsNameTheFileAndTheLine) {
  const auto path = folder_ / "t.tum";
  std::ofstream(path) << "# a comment\n0 0 0 0 0 0 0 1\n1 2 3\n";
  EXPECT_EQ(read_tum(path).error().message,
            path.string() + ": line 3: a pose is eight numbers, time x y z qx qy qz qw");
  std::ofstream(path) << "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n";
  EXPECT_EQ(read_tum(path).error().message, path.string() + ": line 2: the times do not ascend");
}

}  // namespace
}  // namespace sweepscope
