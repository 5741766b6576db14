#include <functional>

#include "core/offset/estimator.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "core/recording/messages/raw_messages.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"
#include "tests/core/recording/zstd_bytes.hpp"

namespace sweepscope {
namespace {

/// One recording of a room, as the simulator writes it, and everything that it is converted to.
class RecordingForms : public testing::Test {
 protected:
  void SetUp() override {
    const Simulation& room = test::simulated("room-1", 0.0243, 2.5);
    ASSERT_TRUE(write_bag(room, folder_ / "room.bag", Job()));
    auto raw = read_raw_recording(folder_ / "room.bag", Rig(), Job());
    ASSERT_TRUE(raw) << raw.error().message;
    raw_ = std::move(*raw);
    original_ = read("room.bag");
    ASSERT_EQ(original_.scans.size(), 100U);
  }
  Recording read(const std::string& name) const {
    auto recording = read_recording(folder_ / name, {}, Job());
    EXPECT_TRUE(recording) << name << ": " << recording.error().message;
    return recording ? std::move(*recording) : Recording();
  }
  void write(RecordingFormat format, const std::string& compression, const std::string& name) const {
    const auto written =
        write_recording(raw_.lasers.at(0), raw_.joints.at(0), format, compression, folder_ / name, Job());
    ASSERT_TRUE(written) << written.error().message;
  }
  using Packing = std::function<std::string(const std::string&)>;

  void write_database(const std::string& name, const Packing& packed = std::identity()) const {
    test::TestDatabase database(folder_ / name);
    const RawLaser& laser = raw_.lasers.at(0);
    const RawJoint& joint = raw_.joints.at(0);
    database.topic(1, laser.topic, "sensor_msgs/msg/LaserScan");
    database.topic(2, joint.topic, "sensor_msgs/msg/JointState");
    for (std::size_t i = 0; i < laser.scans.size(); ++i)
      database.message(1, laser.scans[i].stamps.receive_ns, packed(message_of(Encoding::kCdr, laser, i)));
    for (std::size_t i = 0; i < joint.stamps.size(); ++i)
      database.message(2, joint.stamps[i].receive_ns, packed(message_of(Encoding::kCdr, joint, i)));
  }
  /// As rosbag2 leaves a file of its compression mode FILE.
  void pack(const std::string& name) const {
    test::write_file(folder_ / (name + ".zstd"), test::packed_by_zstd(test::contents_of(folder_ / name)));
  }
  void expect_the_same(const std::string& name) const;

  test::ScratchFolder folder_;
  RawRecording raw_;
  Recording original_;
};

/// To the last bit, NaNs among them.
template <typename T>
bool same_bytes(const std::vector<T>& left, const std::vector<T>& right) {
  return left.size() == right.size() && std::memcmp(left.data(), right.data(), left.size() * sizeof(T)) == 0;
}

void RecordingForms::expect_the_same(const std::string& name) const {
  const Recording form = read(name);
  EXPECT_EQ(form.epoch_ns, original_.epoch_ns) << name;
  ASSERT_EQ(form.scans.size(), original_.scans.size()) << name;
  for (std::size_t i = 0; i < form.scans.size(); ++i) {
    const LaserScan &left = form.scans[i], &right = original_.scans[i];
    EXPECT_EQ(left.first_beam_s, right.first_beam_s) << name << " scan " << i;
    EXPECT_EQ(left.time_increment_s, right.time_increment_s);
    EXPECT_EQ(left.angle_min_rad, right.angle_min_rad);
    EXPECT_EQ(left.angle_increment_rad, right.angle_increment_rad);
    EXPECT_EQ(left.beams, right.beams);
  }
  EXPECT_TRUE(same_bytes(form.ranges_m, original_.ranges_m)) << name;
  EXPECT_TRUE(same_bytes(form.intensities, original_.intensities)) << name;
  EXPECT_TRUE(same_bytes(form.motor.time_s, original_.motor.time_s)) << name;
  EXPECT_TRUE(same_bytes(form.motor.angle_rad, original_.motor.angle_rad)) << name;
  EXPECT_EQ(form.rig.laser.topic, "/scan");
  EXPECT_EQ(form.rig.motor.joint, "roll_motor");
  EXPECT_EQ(form.report.laser_stamps.receive_minus_header_s,
            original_.report.laser_stamps.receive_minus_header_s);
  EXPECT_EQ(form.report.motor_stamps.receive_jitter_s, original_.report.motor_stamps.receive_jitter_s);
  EXPECT_TRUE(form.report.warnings.empty()) << name << ": " << form.report.warnings.front();
}

TEST_F(RecordingForms, HoldTheSameRecordingToTheLastBit) {
  write(RecordingFormat::kCsv, "none", "csv");
  write(RecordingFormat::kRos1, "none", "none.bag");
  write(RecordingFormat::kRos1, "bz2", "bz2.bag");
  write(RecordingFormat::kRos1, "lz4", "lz4.bag");
  write(RecordingFormat::kMcap, "none", "none.mcap");
  write(RecordingFormat::kMcap, "lz4", "lz4.mcap");
  write(RecordingFormat::kMcap, "zstd", "zstd.mcap");
  write_database("room.db3");
  for (const char* name :
       {"csv", "none.bag", "bz2.bag", "lz4.bag", "none.mcap", "lz4.mcap", "zstd.mcap", "room.db3"}) {
    expect_the_same(name);
  }
}

TEST_F(RecordingForms, PackedByRosbag2TheyHoldTheSame) {
  write(RecordingFormat::kMcap, "none", "room.mcap");
  write_database("room.db3");
  pack("room.mcap");
  pack("room.db3");
  write_database("messages.db3", test::packed_by_zstd);
  for (const char* name : {"room.mcap.zstd", "room.db3.zstd", "messages.db3"}) expect_the_same(name);

  std::filesystem::create_directory(folder_ / "bag");
  std::filesystem::rename(folder_ / "room.db3.zstd", folder_ / "bag/bag_0.db3.zstd");
  const auto describe = [&](const std::string& text) {
    test::write_file(folder_ / "bag/metadata.yaml", "rosbag2_bagfile_information:\n" + text);
  };
  describe("  relative_file_paths: [bag_0.db3.zstd]\n  compression_format: zstd\n  compression_mode: FILE\n");
  expect_the_same("bag");
  describe("  relative_file_paths: [bag_0.db3.zstd]\n  compression_format: snappy\n");
  const auto refused = read_recording(folder_ / "bag", {}, Job());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("metadata.yaml:3:23: the bag is compressed as snappy"),
            std::string::npos)
      << refused.error().message;
  std::filesystem::remove(folder_ / "bag/metadata.yaml");
  EXPECT_EQ(read("bag").scans.size(), original_.scans.size());
}

TEST_F(RecordingForms, OfAPackedFileWhatIsWholeIsReadAndOtherThingsAreRefused) {
  write(RecordingFormat::kMcap, "none", "room.mcap");
  const std::string packed = test::packed_by_zstd(test::contents_of(folder_ / "room.mcap"));
  test::write_file(folder_ / "cut", packed.substr(0, packed.size() * 3 / 4));
  const Recording cut = read("cut");
  EXPECT_GT(cut.scans.size(), original_.scans.size() / 2);
  EXPECT_LT(cut.scans.size(), original_.scans.size());
  ASSERT_FALSE(cut.report.warnings.empty());
  for (const std::string& warning : cut.report.warnings)
    EXPECT_EQ(warning.find("sweepscope-"), std::string::npos) << "names a temporary file: " << warning;

  test::write_file(folder_ / "text", test::packed_by_zstd("a text, and no bag"));
  const auto refused = read_recording(folder_ / "text", {}, Job());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(refused.error().message.find("text: byte 0 begins neither"), std::string::npos)
      << refused.error().message;
}

TEST_F(RecordingForms, ADamagedPackedMessageIsCountedAndLeftOut) {
  int number = 0;
  write_database("messages.db3", [&](const std::string& message) {
    std::string packed = test::packed_by_zstd(message);
    if (number++ == 7) packed.resize(packed.size() / 2);
    return packed;
  });
  const Recording recording = read("messages.db3");
  EXPECT_EQ(recording.scans.size(), original_.scans.size() - 1);
  ASSERT_FALSE(recording.report.warnings.empty());
  EXPECT_NE(recording.report.warnings.front().find("message 8"), std::string::npos)
      << recording.report.warnings.front();
}

TEST_F(RecordingForms, GiveTheSameEstimateToTheLastDigit) {
  write(RecordingFormat::kCsv, "none", "csv");
  write(RecordingFormat::kMcap, "zstd", "zstd.mcap");
  write_database("room.db3");
  EstimateOptions options;
  options.method = Method::kStationary;
  options.ranges = {{0.022, 0.027, 0.001}};
  const auto estimated = [&](const Recording& recording) {
    const auto result = estimate(recording, options, Job());
    EXPECT_TRUE(result && result->offset_s);
    return result->offset_s.value_or(0);
  };
  const double offset_s = estimated(original_);
  EXPECT_NEAR(offset_s, 0.0243, 0.001);
  for (const char* name : {"csv", "zstd.mcap", "room.db3"})
    EXPECT_EQ(estimated(read(name)), offset_s) << name;
}

TEST_F(RecordingForms, ThereAndBackGivesTheSameBytes) {
  write(RecordingFormat::kMcap, "lz4", "lz4.mcap");
  write(RecordingFormat::kCsv, "none", "csv");
  const auto from_csv = read_raw_recording(folder_ / "csv", Rig(), Job());
  ASSERT_TRUE(from_csv) << from_csv.error().message;
  ASSERT_TRUE(write_recording(from_csv->lasers[0], from_csv->joints[0], RecordingFormat::kCsv, "none",
                              folder_ / "again", Job()));
  for (const char* table : {"scans.csv", "motor.csv"})
    EXPECT_EQ(test::contents_of(folder_ / "csv" / table), test::contents_of(folder_ / "again" / table));
  const auto from_mcap = read_raw_recording(folder_ / "lz4.mcap", Rig(), Job());
  ASSERT_TRUE(from_mcap);
  ASSERT_TRUE(write_recording(from_mcap->lasers[0], from_mcap->joints[0], RecordingFormat::kRos1, "none",
                              folder_ / "again.bag", Job()));
  EXPECT_TRUE(test::contents_of(folder_ / "again.bag") == test::contents_of(folder_ / "room.bag"));
}

TEST_F(RecordingForms, AnInterruptedWriteLeavesNothing) {
  Job job;
  job.cancel();
  for (const auto& [format, name] :
       {std::pair{RecordingFormat::kMcap, "a.mcap"}, std::pair{RecordingFormat::kRos1, "a.bag"}}) {
    const auto written = write_recording(raw_.lasers[0], raw_.joints[0], format, "none", folder_ / name, job);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ExitCode::kInterrupted);
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
    EXPECT_FALSE(std::filesystem::exists((folder_ / name).string() + ".part"));
  }
}

}  // namespace
}  // namespace sweepscope
