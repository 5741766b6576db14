#include "core/recording/formats/recording_writer.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include "tests/core/recording/message_allocator.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kWrittenStart_ns = 1'700'000'000'000'000'000;

RawLaser two_scans() {
  RawLaser laser;
  laser.topic = "/scan";
  laser.ranges_m = {1, 2, 3, 4};
  laser.intensities = {10, 20, 30, 40};
  for (std::size_t i = 0; i < 2; ++i) {
    RawScan scan;
    scan.stamps = {kWrittenStart_ns + std::int64_t(i) * 25'000'000,
                   kWrittenStart_ns + std::int64_t(i) * 25'000'000 + 7};
    scan.angle_min_rad = -0.5F;
    scan.angle_increment_rad = 0.25F;
    scan.first_range = 2 * i;
    scan.beams = 2;
    laser.scans.push_back(scan);
  }
  return laser;
}

RawLaser one_cloud() {
  RawLaser laser;
  laser.topic = "/points";
  laser.of_clouds = true;
  RawCloud cloud;
  cloud.stamps = {kWrittenStart_ns, kWrittenStart_ns + 7};
  cloud.frame = "lidar";
  cloud.height = 1;
  cloud.width = 2;
  cloud.point_bytes = 4;
  cloud.row_bytes = 8;
  cloud.fields = {{"x", 0, 7, 1}};
  cloud.data.resize(8, std::byte{1});
  cloud.dense = true;
  laser.clouds.push_back(cloud);
  return laser;
}

RawJoint one_sample() {
  RawJoint joint;
  joint.topic = "/joint_states";
  joint.joint = "roll_motor";
  joint.stamps = {{kWrittenStart_ns + 5, kWrittenStart_ns + 9}};
  joint.positions = {0.25};
  return joint;
}

class RecordingWriter : public test::FolderTest {
 protected:
  Result<void> write(const RawLaser& laser, const RawJoint& joint,
                     const std::optional<RawImu>& imu = std::nullopt) const {
    return write_recording(laser, joint, RecordingFormat::kRos1, "none", folder_ / "a.bag", Job(), imu);
  }
};

/// The messages of a topic as rosbag reads them.
template <typename Message>
std::vector<typename Message::Ptr> messages_of(const std::filesystem::path& path, const std::string& topic) {
  std::vector<typename Message::Ptr> all;
  rosbag::Bag bag(path.string());
  for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery(topic)))
    all.push_back(message.instantiate<Message>());
  return all;
}

TEST_F(RecordingWriter, RosReadsScansJointsAndTurnRates) {
  RawImu imu{"/imu", {}};
  imu.rates.stamps = {{kWrittenStart_ns + 1, kWrittenStart_ns + 2}};
  imu.rates.rates_rad_s = {{1, 2, 3}};
  ASSERT_TRUE(write(two_scans(), one_sample(), imu));
  const auto scans = messages_of<sensor_msgs::LaserScan_<MessageAllocator<void>>>(folder_ / "a.bag", "/scan");
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[1]->header.seq, 1U);
  EXPECT_EQ(scans[1]->header.stamp.toNSec(), std::uint64_t{kWrittenStart_ns} + 25'000'000);
  EXPECT_EQ(scans[1]->header.frame_id, "laser");
  EXPECT_EQ(scans[1]->angle_increment, 0.25F);
  ASSERT_EQ(scans[1]->ranges.size(), 2U);
  EXPECT_EQ(scans[1]->ranges[1], 4);
  EXPECT_EQ(scans[1]->intensities[0], 30);
  const auto joints =
      messages_of<sensor_msgs::JointState_<MessageAllocator<void>>>(folder_ / "a.bag", "/joint_states");
  ASSERT_EQ(joints.size(), 1U);
  EXPECT_EQ(joints[0]->name.at(0), "roll_motor");
  EXPECT_EQ(joints[0]->position.at(0), 0.25);
  EXPECT_EQ(joints[0]->velocity.at(0), 0);
  const auto rates = messages_of<sensor_msgs::Imu_<MessageAllocator<void>>>(folder_ / "a.bag", "/imu");
  ASSERT_EQ(rates.size(), 1U);
  EXPECT_EQ(rates[0]->angular_velocity.z, 3);
  EXPECT_EQ(rates[0]->orientation_covariance[0], -1);
  EXPECT_EQ(rates[0]->linear_acceleration_covariance[0], -1);
  EXPECT_EQ(rates[0]->linear_acceleration_covariance[8], 0);
}

TEST_F(RecordingWriter, RosReadsClouds) {
  ASSERT_TRUE(write(one_cloud(), one_sample()));
  const auto clouds =
      messages_of<sensor_msgs::PointCloud2_<MessageAllocator<void>>>(folder_ / "a.bag", "/points");
  ASSERT_EQ(clouds.size(), 1U);
  EXPECT_EQ(clouds[0]->header.frame_id, "lidar");
  EXPECT_EQ(clouds[0]->fields.at(0).name, "x");
  EXPECT_EQ(clouds[0]->fields.at(0).datatype, 7);
  EXPECT_EQ(clouds[0]->row_step, 8U);
  EXPECT_EQ(clouds[0]->data.size(), 8U);
  EXPECT_TRUE(clouds[0]->is_dense);
}

TEST_F(RecordingWriter, AMessageReceivedAtTimeZeroIsReadByRosToo) {
  RawJoint joint = one_sample();
  joint.stamps = {{0, 0}};
  ASSERT_TRUE(write(two_scans(), joint));
  const auto joints =
      messages_of<sensor_msgs::JointState_<MessageAllocator<void>>>(folder_ / "a.bag", "/joint_states");
  EXPECT_EQ(joints.size(), 1U);
}

TEST_F(RecordingWriter, ATimeThatABagCannotHoldIsRefused) {
  RawJoint joint = one_sample();
  joint.stamps.front().header_ns = (std::int64_t{1} << 32) * 1'000'000'000;
  const auto written = write(two_scans(), joint);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("holds no time 4294967296 s"), std::string::npos)
      << written.error().message;
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace sweepscope
