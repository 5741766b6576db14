// An IMU and odometry among a recording's topics: decoded, read where the rig file names them, listed where
// not.
#include <sensor_msgs/Imu.h>

#include <cmath>
#include <functional>

#include "core/recording/formats/read_recording.hpp"
#include "core/recording/messages/messages.hpp"
#include "core/recording/rig.hpp"
#include "core/recording/rig/detect_rig.hpp"
#include "core/recording/streams/message_sink.hpp"
#include "tests/core/recording/message_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::as_span, test::MessageBytes;

std::string imu_bytes(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds,
                      const Vector3d& rate_rad_s, double rate_variance = 0) {
  MessageBytes message(form);
  message.header(seconds, nanoseconds, "imu");
  for (int i = 0; i < 4 + 9; ++i) message.number(-1.0);
  for (const double part : rate_rad_s) message.number(part);
  message.number(rate_variance);
  for (int i = 0; i < 8 + 3 + 9; ++i) message.number(9.81);
  return message.bytes();
}

std::string odometry_bytes(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds,
                           const Vector3d& position_m, const Eigen::Quaterniond& orientation) {
  MessageBytes message(form);
  message.header(seconds, nanoseconds, "odom").text("base_link");
  for (const double part : position_m) message.number(part);
  for (const double part : orientation.coeffs()) message.number(part);
  for (int i = 0; i < 36 + 6 + 36; ++i) message.number(0.5);
  return message.bytes();
}

class MotionMessages : public testing::TestWithParam<MessageBytes::Form> {
 protected:
  Encoding encoding() const { return GetParam() == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr; }
};
INSTANTIATE_TEST_SUITE_P(Ros1AndRos2, MotionMessages,
                         testing::Values(MessageBytes::kRos1, MessageBytes::kCdr,
                                         MessageBytes::kCdrBigEndian));

TEST_P(MotionMessages, AnImuIsDecodedWhereItIsWhole) {
  const std::string bytes = imu_bytes(GetParam(), 12, 5, {0.1, -0.2, 0.3});
  const auto imu = decode_imu(encoding(), as_span(bytes));
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->header_ns, 12'000'000'005);
  EXPECT_EQ(imu->rate_rad_s, Vector3d(0.1, -0.2, 0.3));
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(decode_imu(encoding(), as_span(bytes).first(n)));
}

TEST_P(MotionMessages, AnImuWithoutAGyroscopeIsOfNoUse) {
  const std::string bytes = imu_bytes(GetParam(), 12, 5, {0.1, -0.2, 0.3}, -1);
  EXPECT_FALSE(decode_imu(encoding(), as_span(bytes)));
}

TEST_P(MotionMessages, OdometryIsDecodedWhereItIsWhole) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.7, Vector3d::UnitZ()));
  const std::string bytes = odometry_bytes(GetParam(), 3, 4, {1, 2, 3}, turned);
  const auto odometry = decode_odometry(encoding(), as_span(bytes));
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->header_ns, 3'000'000'004);
  EXPECT_EQ(odometry->position_m, Vector3d(1, 2, 3));
  EXPECT_EQ(odometry->orientation.coeffs(), turned.coeffs());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(decode_odometry(encoding(), as_span(bytes).first(n)));
}

Rig rig_with_imu() {
  Rig rig;
  rig.imu.topic = "/imu";
  rig.imu.pose_in_base_rpy_deg = {0, 0, 90};
  return rig;
}

Result<Recording> read(const std::filesystem::path& path, const Rig& rig) {
  ReadOptions options;
  options.rig = rig;
  return read_recording(path, options, Job());
}

void write_bag_with_imu(const std::filesystem::path& path) {
  test::TestBag bag(path);
  for (int i = 0; i < 40; ++i) bag.scan(test::kStart_s + 0.025 * i);
  for (int i = 0; i < 100; ++i) {
    bag.motor(test::kStart_s + 0.01 * i);
    sensor_msgs::Imu_<MessageAllocator<void>> imu;
    imu.header.stamp = ros::Time(test::kStart_s + 0.01 * i);
    imu.angular_velocity.x = 0.01 * i;
    bag.write("/imu", test::kStart_s + 0.01 * i + test::kReceiveDelay_s, imu);
  }
  bag.close();
}

TEST(MotionTopics, OfARos1BagAnImuIsReadInTheBaseFrame) {
  const test::ScratchFolder folder;
  write_bag_with_imu(folder / "a.bag");
  const auto recording = read(folder / "a.bag", rig_with_imu());
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->turn_rates.time_s.size(), 100U);
  EXPECT_NEAR(recording->turn_rates.time_s[50], recording->scans[0].first_beam_s + 0.5, 1e-9);
  EXPECT_LT((recording->turn_rates.rate_rad_s[50] - Vector3d(0, 0.5, 0)).norm(), 1e-12);
  EXPECT_TRUE(recording->report.warnings.empty());
}

TEST(MotionTopics, ThatTheRigDoesNotNameAreOnlyCountedAndListed) {
  const test::ScratchFolder folder;
  write_bag_with_imu(folder / "a.bag");
  const auto recording = read(folder / "a.bag", Rig());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->turn_rates.time_s.empty());
  const auto detected = detect_rig(folder / "a.bag", {}, Job());
  ASSERT_TRUE(detected) << detected.error().message;
  const std::string text = rig_file_text(*detected);
  EXPECT_NE(text.find("# imu: {topic: /imu, pose_in_base: {xyz_m: [0, 0, 0], rpy_deg: [0, 0, 0]}}"),
            std::string::npos)
      << text;
}

using WriteMessage = std::function<void(std::size_t topic, std::int64_t receive_ns, const std::string&)>;

/// The topics of a ROS 2 bag with an IMU and odometry, from 1.
const std::vector<std::pair<std::string, std::string>> kTopics{
    {"/scan", "sensor_msgs/msg/LaserScan"},
    {"/joint_states", "sensor_msgs/msg/JointState"},
    {"/imu", "sensor_msgs/msg/Imu"},
    {"/odom", "nav_msgs/msg/Odometry"}};

void write_messages(const WriteMessage& write) {
  const auto kCdr = MessageBytes::kCdr;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const std::uint32_t ns = 25'000'000 * i;
    const std::int64_t receive_ns = 1000'000'000'000 + ns;
    write(1, receive_ns, test::scan_bytes(kCdr, 1000, ns, {1, 2, 3, 4, 5}));
    write(2, receive_ns, test::joint_bytes(kCdr, 1000, ns, {"roll"}, {0.1 * i}));
    write(3, receive_ns, imu_bytes(kCdr, 1000, ns, {0.01 * i, 0, 0}));
    write(4, receive_ns, odometry_bytes(kCdr, 1000, ns, {0.1 * i, 0, 0}, Eigen::Quaterniond(1, 0, 0, 0)));
  }
  // An orientation that is none.
  write(4, 1001'000'000'000, odometry_bytes(kCdr, 1001, 0, Vector3d::Zero(), Eigen::Quaterniond(0, 0, 0, 0)));
}

void expect_both(const std::filesystem::path& path) {
  Rig rig = rig_with_imu();
  rig.odometry.topic = "/odom";
  const auto recording = read(path, rig);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->turn_rates.time_s.size(), 40U);
  ASSERT_EQ(recording->odometry.size(), 40U);
  EXPECT_EQ(recording->odometry[20].position_m, Vector3d(2, 0, 0));
  EXPECT_DOUBLE_EQ(recording->odometry[20].time_s, 0.5);
  EXPECT_EQ(recording->report.warnings.size(), 1U);  // of the one that was dropped
}

TEST(MotionTopics, OfARos2DatabaseAreRead) {
  const test::ScratchFolder folder;
  {
    test::TestDatabase database(folder / "a.db3");
    for (std::size_t i = 0; i < kTopics.size(); ++i)
      database.topic(static_cast<int>(i + 1), kTopics[i].first, kTopics[i].second);
    write_messages([&](std::size_t topic, std::int64_t receive_ns, const std::string& bytes) {
      database.message(static_cast<int>(topic), receive_ns, bytes);
    });
  }
  expect_both(folder / "a.db3");
}

TEST(MotionTopics, OfAnMcapFileAreRead) {
  const test::ScratchFolder folder;
  const auto sink = create_mcap_sink(folder / "a.mcap", Compression::kZstd, "ros2", {}).value();
  for (const auto& [name, type] : kTopics)
    ASSERT_TRUE(sink->add_topic({name, type, "cdr", "ros2msg", "", "", {}}));
  write_messages([&](std::size_t topic, std::int64_t receive_ns, const std::string& bytes) {
    ASSERT_TRUE(sink->write(
        {topic - 1, receive_ns, receive_ns, 0, 0, Compression::kNone, std::as_bytes(std::span(bytes))}));
  });
  ASSERT_TRUE(sink->finish({}));
  expect_both(folder / "a.mcap");
}

TEST(MotionTopics, ThatAreNotInTheFileAreWarnedOf) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  const auto recording = read(folder / "a.bag", rig_with_imu());
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->report.warnings.size(), 1U);
  EXPECT_EQ(recording->report.warnings[0],
            "/imu, the rig's imu.topic, has 0 usable messages of sensor_msgs/Imu: it is not used");
}

TEST(MotionTopics, AreNamedInARigFile) {
  const test::ScratchFolder folder;
  test::write_file(folder / "rig.yaml",
                   "imu: {topic: /imu/data, pose_in_base: {xyz_m: [1, 2, 3], rpy_deg: [0, 90, 0]}}\n"
                   "odometry: {topic: /odom}\n");
  const auto rig = read_rig(folder / "rig.yaml");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->imu.topic, "/imu/data");
  EXPECT_EQ(rig->imu.pose_in_base_xyz_m, Vector3d(1, 2, 3));
  EXPECT_EQ(rig->imu.pose_in_base_rpy_deg, Vector3d(0, 90, 0));
  EXPECT_EQ(rig->odometry.topic, "/odom");
  test::write_file(folder / "rig.yaml", "odometry: {pose: 1}\n");
  EXPECT_FALSE(read_rig(folder / "rig.yaml"));
}

}  // namespace
}  // namespace sweepscope
