#include "core/recording/formats/read_recording.hpp"

#include <sys/stat.h>

#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

Result<Recording> read(const std::filesystem::path& path, const ReadOptions& options = {}) {
  return read_recording(path, options, Job());
}

/// The refusal of a file of these bytes, from its name on.
std::string refusal(const std::string& bytes) {
  const test::ScratchFolder folder;
  test::write_file(folder / "a.bag", bytes);
  const auto recording = read(folder / "a.bag");
  if (recording) return "accepted";
  EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput);
  return recording.error().message.substr(recording.error().message.find("a.bag"));
}

class ReadRecording : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Compressed, ReadRecording, testing::Values("none", "bz2", "lz4"));

TEST_P(ReadRecording, FindsScansAndMotorInABag) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "sample.bag", GetParam());
  const auto recording = read(folder / "sample.bag");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->name, "sample.bag");
  EXPECT_EQ(recording->epoch_ns, 1001'000'000'000);
  ASSERT_EQ(recording->scans.size(), std::size_t{test::kSampleScans});
  ASSERT_EQ(recording->motor.time_s.size(), std::size_t{test::kSampleMotor});
  EXPECT_NEAR(recording->scans[10].first_beam_s, 0.25, 1e-9);
  EXPECT_NEAR(recording->scans[10].time_increment_s, 0.001, 1e-9);
  EXPECT_EQ(recording->ranges(recording->scans[10])[2], 3);
  EXPECT_NEAR(recording->motor.angle_at(0.25), 0, 1e-9);
  EXPECT_NEAR(recording->motor.angle_at(0.625), 0.5, 1e-9);
  EXPECT_TRUE(recording->report.warnings.empty());
  ASSERT_EQ(recording->report.topics.size(), 2U);
}

TEST_P(ReadRecording, UsesWhatIsWholeInACutBagAndWarns) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "sample.bag", GetParam());
  const std::string whole = test::contents_of(folder / "sample.bag");
  test::write_file(folder / "cut.bag", whole.substr(0, whole.size() * 2 / 3));
  const auto recording = read(folder / "cut.bag");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_GT(recording->scans.size(), 50U);
  EXPECT_LT(recording->scans.size(), std::size_t{test::kSampleScans});
  ASSERT_FALSE(recording->report.warnings.empty());
  EXPECT_NE(recording->report.warnings[0].find("cut short"), std::string::npos);
}

TEST_P(ReadRecording, HasNoRecordingInABagThatIsCutBeforeItsFirstMessages) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "sample.bag", GetParam());
  test::write_file(folder / "cut.bag", test::contents_of(folder / "sample.bag").substr(0, 4300));
  const auto recording = read(folder / "cut.bag");
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(recording.error().message.find("nothing in it can be used: it is cut short"), std::string::npos);
}

TEST(ReadRecordingOfJoints, GathersAJointThatIsSpreadOverMessagesAndPublishers) {
  const test::ScratchFolder folder;
  {
    test::TestBag bag(folder / "a.bag");
    for (int i = 0; i < 40; ++i) {
      const double t_s = test::kStart_s + 0.025 * i;
      bag.scan(t_s);
      bag.write("/joint_states", t_s, test::sample_joints(t_s, {"left_wheel", "right_wheel"}, {0, 0}));
      bag.write("/joint_states", t_s, test::sample_joints(t_s, {"arm", "roll_motor"}, {1, 0.02 * i}));
      auto no_positions = test::sample_joints(t_s, {"arm"}, {});
      no_positions.velocity = {5};
      bag.write("/joint_states", t_s, no_positions);
    }
    bag.close();
  }
  const auto recording = read(folder / "a.bag");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rig.motor.joint, "roll_motor");
  ASSERT_EQ(recording->motor.time_s.size(), 40U);
  EXPECT_NEAR(recording->motor.angle_rad[10], 0.2, 1e-12);
}

TEST(ReadRecordingOfJoints, TheRigChoosesAmongTopicsAndJoints) {
  const test::ScratchFolder folder;
  {
    test::TestBag bag(folder / "a.bag");
    for (int i = 0; i < 10; ++i) {
      const double t_s = test::kStart_s + 0.025 * i;
      bag.scan(t_s);
      bag.write("/scan_2", t_s, test::sample_scan(t_s, {9}));
      bag.write("/joint_states", t_s, test::sample_joints(t_s, {"wheel", "roll_motor"}, {1.0 * i, -0.5 * i}));
    }
    bag.close();
  }
  EXPECT_NE(read(folder / "a.bag").error().message.find("2 topics of scans"), std::string::npos);
  ReadOptions options{Rig(), {}};
  options.rig->laser.topic = "/scan_2";
  EXPECT_NE(read(folder / "a.bag", options).error().message.find("2 of 2 joints move"), std::string::npos);
  options.rig->motor.joint = "roll_motor";
  const auto recording = read(folder / "a.bag", options);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->ranges_m[0], 9);
  EXPECT_NEAR(recording->motor.angle_rad.back(), -4.5, 1e-12);
}

/// A bag of scans and motor samples in which some scans' bytes are no scans.
std::string bag_with_malformed_scans(int scans, int malformed) {
  using test::RawBag;
  std::string records = RawBag::connection(0, "/scan", "sensor_msgs/LaserScan");
  for (int i = 0; i < scans + malformed; ++i) {
    const auto message = test::sample_scan(10 + i);
    std::string bytes(ros::serialization::serializationLength(message), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, message);
    if (i < malformed) bytes[bytes.size() - 25] = '\x7F';  // the top byte of the count of ranges
    records += RawBag::message(0, 10, bytes);
  }
  records += RawBag::connection(1, "/joints", "sensor_msgs/JointState");
  for (int i = 0; i < 8; ++i) {
    const auto message = test::sample_joints(9 + i, {"roll"}, {0.1 * i});
    std::string bytes(ros::serialization::serializationLength(message), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, message);
    records += RawBag::message(1, 10, bytes);
  }
  return RawBag::magic() + RawBag::bag_header(1) + RawBag::chunk("none", records.size(), records);
}

TEST(ReadRecordingOfDamage, MalformedMessagesAreCountedAndSkippedNamingThePlace) {
  const test::ScratchFolder folder;
  test::write_file(folder / "a.bag", bag_with_malformed_scans(3, 2));
  const auto recording = read(folder / "a.bag");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->scans.size(), 3U);
  EXPECT_EQ(recording->report.topics[0].malformed, 2U);
  const std::string& warning = recording->report.warnings.back();
  EXPECT_NE(warning.find("2 of 5 messages on /scan are malformed and were skipped, the first at byte"),
            std::string::npos)
      << warning;
}

TEST(ReadRecordingOfDamage, ABagWithoutOneWholeScanIsRefused) {
  EXPECT_NE(refusal(bag_with_malformed_scans(0, 2))
                .find("a.bag: nothing in it can be used: 2 of 2 messages on /scan are malformed"),
            std::string::npos);
}

TEST(ReadRecordingOfDamage, AnotherVersionOfAMessageIsNotUsed) {
  using test::RawBag;
  const std::string text =
      refusal(RawBag::magic() + RawBag::bag_header(1) +
              RawBag::connection(0, "/scan", "sensor_msgs/LaserScan", "00000000000000000000000000000000") +
              RawBag::message(0, 10, "bytes"));
  EXPECT_NE(text.find("topic /scan holds another version of sensor_msgs/LaserScan"), std::string::npos)
      << text;
}

TEST(ReadRecordingOfDamage, RefusesWhatIsNoRecording) {
  EXPECT_EQ(refusal(""), "a.bag: is empty");
  EXPECT_EQ(refusal("stamp, range\n0.1, 2\n").substr(0, 83),
            "a.bag: its first bytes are not those of a known recording format; sweepscope reads ");
  EXPECT_EQ(refusal("#").substr(0, 83),
            "a.bag: its first bytes are not those of a known recording format; sweepscope reads ");
  EXPECT_EQ(refusal("#ROSBAG V1.2\n1234567890").substr(0, 82),
            "a.bag: is a ROS 1 bag of format 1; convert it with `rosbag fix`; sweepscope reads ");
  EXPECT_EQ(refusal("#ROSBAG V2.0\n"),
            "a.bag: nothing in it can be used: it has no bag header; its intact part was read");
  EXPECT_EQ(refusal("#ROSBAG V2.0\n" + std::string(100, '\xFF')).substr(0, 63),
            "a.bag: nothing in it can be used: there is no record at byte 13");
}

TEST(ReadRecordingOfDamage, RefusesWhatIsNoFile) {
  const test::ScratchFolder folder;
  EXPECT_EQ(read("/nowhere/a.bag").error().message, "/nowhere/a.bag: no such file");
  std::filesystem::create_directory(folder / "folder.bag");
  EXPECT_NE(read(folder / "folder.bag").error().message.find("folder.bag: is a folder"), std::string::npos);
  ASSERT_EQ(mkfifo((folder / "pipe.bag").c_str(), 0600), 0);
  EXPECT_NE(read(folder / "pipe.bag").error().message.find("pipe.bag: is not a regular file"),
            std::string::npos);
}

TEST(ReadRecordingOfDamage, IsInterrupted) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  Job job;
  job.cancel();
  const auto recording = read_recording(folder / "a.bag", {}, job);
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, ExitCode::kInterrupted);
}

}  // namespace
}  // namespace sweepscope
