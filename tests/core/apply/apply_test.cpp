#include "core/apply/apply.hpp"

#include <std_msgs/String.h>

#include "core/recording/formats/read_recording.hpp"
#include "tests/core/apply/seen_messages.hpp"
#include "tests/core/recording/cloud_bytes.hpp"
#include "tests/core/recording/message_bytes.hpp"
#include "tests/core/recording/test_database.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;
using namespace test;

class Apply : public ApplyTest {
 protected:
  /// Scans, motor samples, and messages that are not known.
  fs::path bag(const std::string& compression = "none") const {
    const fs::path path = folder_ / ("in-" + compression + ".bag");
    test::TestBag bag(path, compression);
    for (int i = 0; i < 200; ++i) {  // in the order of time, as rosbag gives them back
      std_msgs::String_<MessageAllocator<void>> text;
      text.data.assign(static_cast<std::size_t>(i), 'x');
      bag.write("/words", test::kStart_s + 0.01 * i + 0.001, text);
      bag.motor(test::kStart_s + 0.01 * i);
      if (i % 3 == 0) bag.scan(test::kStart_s + 0.01 * i + 0.002);
    }
    bag.close();
    return path;
  }
  /// The same as a database of ROS 2, in a folder.
  fs::path database() const {
    fs::create_directory(folder_ / "in");
    test::TestDatabase database(folder_ / "in/in_0.db3");
    database.topic(1, "/joint_states", "sensor_msgs/msg/JointState");
    database.topic(2, "/words", "example/msg/Unknown");
    for (int i = 0; i < 100; ++i) {
      MessageBytes bytes(MessageBytes::kCdr);
      bytes.header(1000, static_cast<std::uint32_t>(10'000'000 * i), "")
          .number(std::uint32_t{1})
          .text("roll");
      bytes.array<double>({0.1 * i}).array<double>({}).array<double>({});
      database.message(1, 1000 * kSecond_ns + i, bytes.bytes());
      database.message(2, 1000 * kSecond_ns + i, std::string(static_cast<std::size_t>(i), 'y'));
    }
    std::ofstream(folder_ / "in/metadata.yaml")
        << "rosbag2_bagfile_information:\n  relative_file_paths:\n    - in_0.db3\n";
    return folder_ / "in";
  }
};

TEST_F(Apply, OfABagOnlyTheMotorsHeaderStampsChange) {
  for (const char* compression : {"none", "bz2", "lz4"}) {
    const fs::path in = bag(compression);
    const auto applied = apply(in, "out.bag");
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_EQ(applied->moved, 200U);
    expect_moved(of_bag(in), of_bag(folder_ / "out.bag"), -24'000'000);
    const std::string bytes = test::contents_of(folder_ / "out.bag");
    EXPECT_NE(bytes.find(std::string("compression=") + compression), std::string::npos);
    fs::remove(folder_ / "out.bag");
  }
}

TEST_F(Apply, ABagBecomesAnMcapFileAndABagAgain) {
  const fs::path in = bag();
  ASSERT_TRUE(apply(in, "out.mcap"));
  expect_moved(of_bag(in), of_mcap(folder_ / "out.mcap"), -24'000'000, false);
  ApplyOptions back = at_24_ms();
  back.offset.offset_s = -0.024;
  back.again = true;
  const auto again = apply(folder_ / "out.mcap", "back.bag", back);
  ASSERT_TRUE(again) << again.error().message;
  expect_moved(of_bag(in), of_bag(folder_ / "back.bag"), 0, false);
}

TEST_F(Apply, OfADatabaseOnlyTheMotorsHeaderStampsChange) {
  const fs::path in = database();
  const auto applied = apply(in, "out");
  ASSERT_TRUE(applied) << applied.error().message;
  expect_moved(of_database(in / "in_0.db3"), of_database(folder_ / "out/in_0.db3"), -24'000'000);
  EXPECT_EQ(test::contents_of(folder_ / "out/metadata.yaml"), test::contents_of(in / "metadata.yaml"));
  ASSERT_TRUE(apply(in, "out.mcap"));
  expect_moved(of_database(in / "in_0.db3"), of_mcap(folder_ / "out.mcap"), -24'000'000, false);
}

TEST_F(Apply, AnMcapFileKeepsItsChannelsAndCompression) {
  for (const char* name :
       {"ros1_lz4", "ros2", "ros2_lz4", "ros2_unchunked", "ros2_zstd", "ros2_zstd_unindexed"}) {
    const fs::path in = fs::path(SWEEPSCOPE_SOURCE_DIR) / "tests/data/mcap" / (std::string(name) + ".mcap");
    const fs::path out = folder_ / "out.mcap";
    const auto applied = apply(in, "out.mcap");
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_EQ(applied->moved, 120U) << name;
    const auto before = read_recording(in, {}, Job()), after = read_recording(out, {}, Job());
    ASSERT_TRUE(before && after) << name;
    EXPECT_EQ(before->ranges_m.size(), after->ranges_m.size());
    ASSERT_EQ(before->motor.time_s.size(), after->motor.time_s.size());
    const double before_s = static_cast<double>(before->epoch_ns - after->epoch_ns) * 1e-9;
    for (std::size_t i = 0; i < before->motor.time_s.size(); ++i)
      EXPECT_NEAR(after->motor.time_s[i], before->motor.time_s[i] + before_s - 0.024, 1e-8);
    fs::remove(out);
  }
}

TEST_F(Apply, TheLasersStampsMoveTheOtherWay) {
  ApplyOptions options = at_24_ms();
  options.shifted = ShiftedStream::kLaser;
  const fs::path in = bag();
  ASSERT_TRUE(apply(in, "out.bag", options));
  const auto before = of_bag(in), after = of_bag(folder_ / "out.bag");
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool scan = before[i].topic == "/scan";
    if (scan) {
      EXPECT_EQ(stamp_ns(after[i].bytes) - stamp_ns(before[i].bytes), 24'000'000);
    } else {
      EXPECT_EQ(before[i], after[i]);
    }
  }
}

/// Clouds of a Livox scanner whose points' times begin at `base_ns`, and a motor that turns.
void write_livox(const fs::path& path, std::uint64_t base_ns) {
  test::TestDatabase database(path);
  database.topic(1, "/joint_states", "sensor_msgs/msg/JointState");
  database.topic(2, "/livox/lidar", "livox_ros_driver2/msg/CustomMsg");
  test::LivoxBytes cloud;
  for (int beam = 0; beam < 60; ++beam) {
    const auto x_m = static_cast<float>(5 + 0.01 * beam);
    cloud.point({x_m, static_cast<float>(0.05 * beam), 0.5F, static_cast<std::uint32_t>(beam) * 100'000});
  }
  for (int i = 0; i < 50; ++i) {
    const auto ns = static_cast<std::uint32_t>(10'000'000 * i);
    MessageBytes joint(MessageBytes::kCdr);
    joint.header(1000, ns, "").number(std::uint32_t{1}).text("roll");
    joint.array<double>({0.1 * i}).array<double>({}).array<double>({});
    database.message(1, 1000 * kSecond_ns + ns, joint.bytes());
    const std::uint64_t points_ns = base_ns == 0 ? 0 : base_ns + ns;
    database.message(2, 1000 * kSecond_ns + ns, cloud.message(MessageBytes::kCdr, 1000, ns, points_ns));
  }
}

TEST_F(Apply, OfALivoxScannerTheMotorsOrTheHeadersStampsMove) {
  for (const bool of_motor : {true, false}) {
    const fs::path in = folder_ / "in.db3", out = folder_ / "out.db3";
    write_livox(in, 0);
    ApplyOptions options = at_24_ms();
    options.shifted = of_motor ? ShiftedStream::kMotor : ShiftedStream::kLaser;
    const auto applied = apply(in, "out.db3", options);
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_EQ(applied->moved, 50U);
    const auto before = of_database(in), after = of_database(out);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool moved = (before[i].topic == "/joint_states") == of_motor;
      const std::int64_t by_ns = moved ? (of_motor ? -24'000'000 : 24'000'000) : 0;
      EXPECT_EQ(stamp_ns(after[i].bytes) - stamp_ns(before[i].bytes), by_ns) << i;
    }
    fs::remove(in);
    fs::remove(out);
  }
}

TEST_F(Apply, WhereALivoxScannersPointsCountSince1970ItsStampsCannotMove) {
  write_livox(folder_ / "in.db3", 1'700'000'000'000'000'000);
  ApplyOptions options = at_24_ms();
  options.shifted = ShiftedStream::kLaser;
  const auto refused = apply(folder_ / "in.db3", "out.db3", options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(refused.error().message.find("use --shift motor"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "out.db3"));
}

TEST_F(Apply, ByReceiveTheTimesOfTheMotorsMessagesMoveAndNoByteOfThem) {
  ApplyOptions options = at_24_ms();
  options.stamps = StampSource::kReceive;
  const fs::path in = bag();
  ASSERT_TRUE(apply(in, "out.bag", options));
  std::map<std::string, std::vector<Seen>> before, after;  // rosbag gives them in the order of time
  for (const Seen& seen : of_bag(in)) before[seen.topic].push_back(seen);
  for (const Seen& seen : of_bag(folder_ / "out.bag")) after[seen.topic].push_back(seen);
  for (Seen& seen : before["/joint_states"]) seen.receive_ns -= 24'000'000;
  for (const char* topic : {"/joint_states", "/scan", "/words"})
    EXPECT_EQ(before[topic], after[topic]) << topic;
}

TEST_F(Apply, MessagesOfAnotherPublisherOnTheMotorsTopicStay) {
  test::TestBag bag(folder_ / "in.bag");
  for (int i = 0; i < 100; ++i) {
    bag.motor(test::kStart_s + 0.01 * i);
    bag.write("/joint_states", test::kStart_s + 0.01 * i + 0.007,
              test::sample_joints(test::kStart_s + 0.01 * i, {"wheel"}, {0.0}));
  }
  bag.close();
  const auto applied = apply(folder_ / "in.bag", "out.bag");
  ASSERT_TRUE(applied) << applied.error().message;
  EXPECT_EQ(applied->moved, 100U);
  EXPECT_TRUE(applied->warnings.empty());
  const auto before = of_bag(folder_ / "in.bag"), after = of_bag(folder_ / "out.bag");
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool wheel = before[i].bytes.find("wheel") != std::string::npos;
    EXPECT_EQ(before[i] == after[i], wheel) << i;
  }
}

TEST_F(Apply, ASecondTimeIsRefusedUnlessItIsAskedFor) {
  for (const char* name : {"out.bag", "out.mcap"}) {
    ASSERT_TRUE(apply(bag(), name));
    const auto twice = apply(folder_ / name, "twice.mcap");
    ASSERT_FALSE(twice) << name;
    EXPECT_EQ(twice.error().code, ExitCode::kWrongUsage);
    EXPECT_NE(twice.error().message.find("an offset was applied before"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder_ / "twice.mcap"));
  }
  ASSERT_TRUE(apply(database(), "out"));
  EXPECT_FALSE(apply(folder_ / "out", "twice"));
  ApplyOptions again = at_24_ms();
  again.again = true;
  ASSERT_TRUE(apply(folder_ / "out", "twice", again));
  expect_moved(of_database(folder_ / "in/in_0.db3"), of_database(folder_ / "twice/in_0.db3"), -48'000'000);
}

TEST_F(Apply, WhatTheOutputCannotHoldIsRefused) {
  const fs::path in = bag();
  const auto refused = [&](const fs::path& recording, const std::string& output) {
    const auto applied = apply(recording, output);
    EXPECT_FALSE(applied) << output;
    EXPECT_FALSE(fs::exists(folder_ / output)) << output;
    return applied ? "" : applied.error().message;
  };
  EXPECT_NE(refused(in, "out.db3").find("holds messages of ROS 2 only"), std::string::npos);
  EXPECT_NE(refused(in, "out").find("name OUT.bag or OUT.mcap"), std::string::npos);
  EXPECT_NE(refused(in, "out.xyz").find("has no known extension"), std::string::npos);
  EXPECT_NE(refused(database(), "out.bag").find("holds messages of ROS 1 only"), std::string::npos);
}

TEST_F(Apply, InterruptedAtAnyMomentItLeavesNothing) {
  const fs::path in = bag(), database_in = database();
  for (const auto& [recording, output] :
       {std::pair(in, "out.bag"), std::pair(in, "out.mcap"), std::pair(database_in, "out")}) {
    for (std::uint64_t look = 1;; ++look) {
      LookCount looks(look);
      Job job;
      job.obey(looks);
      const auto applied = apply_offset(recording, folder_ / output, at_24_ms(), job);
      if (applied) break;
      ASSERT_EQ(applied.error().code, ExitCode::kInterrupted);
      for (const auto& entry : fs::directory_iterator(folder_))
        ASSERT_TRUE(entry.path().filename().string().starts_with("in")) << entry.path();
    }
    fs::remove_all(folder_ / output);
  }
}

}  // namespace
}  // namespace sweepscope
