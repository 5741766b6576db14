#include "core/recording/ros2/sqlite_bag.hpp"

#include "core/recording/formats/read_recording.hpp"
#include "tests/core/recording/message_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"
#include "tests/scratch_folder.hpp"

namespace sweepscope {
namespace {

using test::MessageBytes, test::TestDatabase;

constexpr int kBagScans = 40, kBagSamples = 120;

/// One second of scans on /scan and of a motor's joint on /joint_states.
void write_sample(TestDatabase& database) {
  database.topic(1, "/scan", "sensor_msgs/msg/LaserScan");
  database.topic(2, "/joint_states", "sensor_msgs/msg/JointState");
  for (int i = 0; i < kBagScans; ++i)
    database.message(
        1, 10'005'000'000 + 25'000'000 * i,
        test::scan_bytes(MessageBytes::kCdr, 10, 25'000'000U * unsigned(i), {1, 2, float(3 + i)}));
  for (int i = 0; i < kBagSamples; ++i) {
    const std::int64_t ns = 9'900'000'000 + 10'000'000 * i;
    database.message(2, ns + 5'000'000,
                     test::joint_bytes(MessageBytes::kCdr, std::uint32_t(ns / 1'000'000'000),
                                       std::uint32_t(ns % 1'000'000'000), {"roll_motor"}, {0.01 * i}));
  }
}

/// More scans, after those of write_sample().
void write_sample_again(TestDatabase& database) {
  for (int i = 0; i < kBagScans; ++i)
    database.message(1, 11'005'000'000 + 25'000'000 * i,
                     test::scan_bytes(MessageBytes::kCdr, 11, 25'000'000U * unsigned(i), {1, 2, 3}));
}

class SqliteBag : public testing::Test {
 protected:
  Result<Recording> read(const std::string& name) const { return read_recording(folder_ / name, {}, Job()); }
  std::string refusal(const std::string& name) const {
    const auto recording = read(name);
    if (recording) return "accepted";
    EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput);
    return recording.error().message;
  }
  void write(const std::string& name) const {
    TestDatabase database(folder_ / name);
    write_sample(database);
  }

  test::ScratchFolder folder_;
};

TEST_F(SqliteBag, IsReadInFullWhateverItsName) {
  for (const char* name : {"a.db3", "a", "what?#100%.bag"}) {
    write(name);
    const auto recording = read(name);
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(recording->name, name);
    ASSERT_EQ(recording->scans.size(), std::size_t{kBagScans});
    ASSERT_EQ(recording->motor.time_s.size(), std::size_t{kBagSamples});
    EXPECT_EQ(recording->epoch_ns, 10'000'000'000);
    EXPECT_NEAR(recording->scans[10].first_beam_s, 0.25, 1e-12);
    EXPECT_EQ(recording->ranges(recording->scans[10])[2], 13);
    EXPECT_NEAR(recording->motor.angle_at(0.25), 0.35, 1e-9);
    EXPECT_NEAR(*recording->report.motor_stamps.receive_minus_header_s, 0.005, 1e-12);
    EXPECT_TRUE(recording->report.warnings.empty());
    EXPECT_EQ(recording->report.topics[0].type, "sensor_msgs/msg/LaserScan");
    EXPECT_FALSE(std::filesystem::exists((folder_ / name).string() + "-shm"));
  }
}

TEST_F(SqliteBag, AFoldersFilesAreReadInTheOrderOfItsMetadata) {
  std::filesystem::create_directories(folder_ / "bag");
  {
    TestDatabase first(folder_ / "bag/bag_0.db3"), second(folder_ / "bag/bag_1.db3");
    write_sample(first);
    second.topic(7, "/scan", "sensor_msgs/msg/LaserScan");
    second.message(7, 12'000'000'000, test::scan_bytes(MessageBytes::kCdr, 12, 0, {1, 2, 3}));
  }
  const std::string head = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n";
  const auto describe = [&](const std::string& text) {
    test::write_file(folder_ / "bag/metadata.yaml", head + text);
  };
  describe("  relative_file_paths: [bag_0.db3, bag/bag_1.db3]\n  compression_mode: \"\"\n");
  for (const char* name : {"bag", "bag/"}) {
    const auto recording = read(name);
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(recording->name, "bag");
    EXPECT_EQ(recording->scans.size(), std::size_t{kBagScans + 1});
    EXPECT_TRUE(recording->report.warnings.empty());
  }
  describe("  relative_file_paths: [bag_0.db3]\n");
  EXPECT_EQ(read("bag")->scans.size(), std::size_t{kBagScans});
  describe("  relative_file_paths: [../../bag_2.db3]\n");
  EXPECT_NE(refusal("bag").find("bag/bag_2.db3: no such file"), std::string::npos) << refusal("bag");
  describe("  relative_file_paths: []\n");
  EXPECT_NE(refusal("bag").find("it names no files"), std::string::npos);
  test::write_file(folder_ / "bag/metadata.yaml", "[1, 2]");
  EXPECT_NE(refusal("bag").find("metadata.yaml:1:1: there is no rosbag2_bagfile_information"),
            std::string::npos)
      << refusal("bag");
  std::filesystem::remove(folder_ / "bag/metadata.yaml");
  const auto without = read("bag");
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_EQ(without->scans.size(), std::size_t{kBagScans + 1});
  EXPECT_EQ(without->report.warnings.at(0),
            "the folder has no metadata.yaml; its bags were read in the order of their names");
}

TEST_F(SqliteBag, ARecorderThatWasNotEndedLeavesItsJournal) {
  {
    TestDatabase database(folder_ / "live.db3", "WAL");
    write_sample(database);
    ASSERT_TRUE(std::filesystem::exists(folder_ / "live.db3-wal"));
    for (const char* end : {"", "-wal"})
      std::filesystem::copy_file(folder_ / (std::string("live.db3") + end),
                                 folder_ / (std::string("left.db3") + end));
  }
  const auto recording = read("left.db3");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->scans.size(), std::size_t{kBagScans});
}

TEST_F(SqliteBag, ReadingLeavesTheFolderAsItWas) {
  {
    TestDatabase live(folder_ / "live.db3", "WAL"), closed(folder_ / "closed.db3", "WAL");
    write_sample(live);
    write_sample(closed);
    for (const char* copy : {"journal", "both"}) {
      std::filesystem::create_directories(folder_ / copy);
      for (const std::string end : {"", "-wal"})
        std::filesystem::copy_file(folder_ / ("live.db3" + end), folder_ / copy / ("a.db3" + end));
    }
    std::filesystem::copy_file(folder_ / "live.db3-shm", folder_ / "both" / "a.db3-shm");
  }
  std::filesystem::create_directories(folder_ / "closed");
  std::filesystem::rename(folder_ / "closed.db3", folder_ / "closed" / "a.db3");
  for (const char* folder : {"closed", "journal", "both"}) {
    const auto before = test::files_in(folder_ / folder);
    const auto recording = read(std::string(folder) + "/a.db3");
    ASSERT_TRUE(recording) << folder << ": " << recording.error().message;
    EXPECT_EQ(recording->scans.size(), std::size_t{kBagScans}) << folder;
    EXPECT_TRUE(recording->report.warnings.empty()) << folder;
    EXPECT_TRUE(test::files_in(folder_ / folder) == before) << folder;
  }
}

TEST_F(SqliteBag, AWriteThatIsHalfDoneIsRefusedWithWhatToDo) {
  std::filesystem::create_directories(folder_ / "left");
  {
    TestDatabase database(folder_ / "live.db3", "DELETE");
    write_sample(database);
    database.run("COMMIT; PRAGMA cache_size = 2; BEGIN");
    write_sample_again(database);
    for (const std::string end : {"", "-journal"})
      std::filesystem::copy_file(folder_ / ("live.db3" + end), folder_ / "left" / ("a.db3" + end));
  }
  const auto before = test::files_in(folder_ / "left");
  EXPECT_NE(refusal("left/a.db3")
                .find("a.db3: its recorder was killed during a write, which a.db3-journal rolls back"),
            std::string::npos)
      << refusal("left/a.db3");
  EXPECT_TRUE(test::files_in(folder_ / "left") == before);
}

TEST_F(SqliteBag, CutAnywhereItIsReadAsFarAsItGoesWithAWarning) {
  write("a.db3");
  const std::string whole = test::contents_of(folder_ / "a.db3");
  std::size_t read_in_part = 0;
  for (std::size_t bytes = 1; bytes < whole.size(); bytes += 701) {
    test::write_file(folder_ / "cut.db3", whole.substr(0, bytes));
    const auto recording = read("cut.db3");
    if (recording) {
      EXPECT_FALSE(recording->report.warnings.empty()) << "cut at " << bytes;
      ++read_in_part;
    } else {
      EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput) << "cut at " << bytes;
    }
  }
  EXPECT_GT(read_in_part, 0U);
}

TEST_F(SqliteBag, AnyDamagedByteNeverDoesWorseThanARefusal) {
  write("a.db3");
  const std::string whole = test::contents_of(folder_ / "a.db3");
  for (std::size_t at = 0; at < whole.size(); at += 389) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    test::write_file(folder_ / "b.db3", damaged);
    const auto recording = read("b.db3");
    if (!recording) {
      EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput) << at;
    }
  }
}

TEST_F(SqliteBag, WhatIsNoBagIsRefusedWithTheReason) {
  { TestDatabase empty(folder_ / "a.db3", "DELETE", false); }
  TestDatabase(folder_ / "b.db3", "DELETE", false).run("CREATE TABLE topics(id INTEGER)");
  TestDatabase(folder_ / "c.db3", "DELETE", false)
      .run("CREATE TABLE topics(id INTEGER); CREATE TABLE messages(id INTEGER)");
  EXPECT_NE(refusal("b.db3").find("b.db3: is an SQLite database without the tables topics and messages"),
            std::string::npos);
  EXPECT_NE(refusal("c.db3").find("c.db3: its table of topics cannot be read: no such column: name"),
            std::string::npos)
      << refusal("c.db3");
  test::write_file(folder_ / "d.db3", std::string("SQLite format 3\0", 16) + std::string(5000, 'x'));
  EXPECT_NE(refusal("d.db3").find("d.db3: is an SQLite database that cannot be read: "), std::string::npos)
      << refusal("d.db3");
}

TEST_F(SqliteBag, AViewInThePlaceOfATableIsNotRun) {
  TestDatabase database(folder_ / "a.db3", "DELETE", false);
  database.run(
      "CREATE TABLE topics(id INTEGER, name, type, serialization_format);CREATE VIEW messages AS WITH "
      "RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i AS id, 1 AS topic_id, i AS "
      "timestamp, x'00' AS data FROM n");
  EXPECT_NE(refusal("a.db3").find("without the tables topics and messages"), std::string::npos);
}

TEST_F(SqliteBag, MalformedMessagesAreCountedAndTheFirstIsNamed) {
  {
    TestDatabase database(folder_ / "a.db3");
    write_sample(database);
    database.message(1, 1, "short");
    database.message(1, 1, "short");
    database.message(99, 1, "of no topic");
  }
  const auto recording = read("a.db3");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->report.warnings,
            (std::vector<std::string>{
                "1 messages belong to no topic",
                "2 of 42 messages on /scan are malformed and were skipped, the first at message 161"}));
}

TEST_F(SqliteBag, IsInterrupted) {
  write("a.db3");
  Job job;
  job.cancel();
  const auto recording = read_recording(folder_ / "a.db3", {}, job);
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, ExitCode::kInterrupted);
}

}  // namespace
}  // namespace sweepscope
