// What apply writes, read by others: rosbag, SQLite, and a reader of MCAP files that goes by their index.
#include "core/apply/apply.hpp"

#include <rosbag/view.h>
#include <sqlite3.h>
#include <std_msgs/String.h>

#include <boost/crc.hpp>
#include <cstring>
#include <map>
#include <tuple>

#include "core/recording/formats/read_recording.hpp"
#include "tests/core/recording/cloud_bytes.hpp"
#include "tests/core/recording/message_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;
using test::MessageBytes;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// A message with all that describes it.
struct Seen {
  std::string topic;
  std::int64_t receive_ns;
  std::string bytes;
  std::string description;

  auto key() const { return std::tie(topic, receive_ns, bytes, description); }
  bool operator==(const Seen& other) const { return key() == other.key(); }
};

/// But for the record of what was done.
std::vector<Seen> of_bag(const fs::path& path) {
  const RosHome home;
  rosbag::Bag bag(path.string());
  rosbag::View view(bag);
  std::vector<Seen> all;
  for (const rosbag::MessageInstance& message : view) {
    if (message.getTopic() == kAppliedTopic) continue;
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    std::string description;
    for (const auto& [name, value] : *message.getConnectionHeader()) description += name + "=" + value + ";";
    all.push_back(
        {message.getTopic(), static_cast<std::int64_t>(message.getTime().toNSec()), bytes, description});
  }
  return all;
}

template <typename T>
T number(const std::string& bytes, std::size_t at) {
  T value{};
  EXPECT_LE(at + sizeof(T), bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::string text(const std::string& bytes, std::size_t& at) {
  const auto length = number<std::uint32_t>(bytes, at);
  at += 4 + length;
  return bytes.substr(at - length, length);
}

/// The records of a part of an MCAP file: operation, place, content.
std::vector<std::tuple<int, std::size_t, std::string>> mcap_records(const std::string& bytes, std::size_t at,
                                                                    std::size_t end) {
  std::vector<std::tuple<int, std::size_t, std::string>> records;
  while (at < end) {
    const auto length = number<std::uint64_t>(bytes, at + 1);
    records.emplace_back(static_cast<unsigned char>(bytes[at]), at, bytes.substr(at + 9, length));
    at += 9 + length;
  }
  return records;
}

/// Of a file whose chunks are not compressed: through the summary and the indexes of the chunks.
std::vector<Seen> of_mcap(const fs::path& path) {
  constexpr std::size_t kEnd_bytes = 9 + 20 + 8;
  const std::string bytes = test::contents_of(path);
  const std::size_t footer = bytes.size() - kEnd_bytes;
  std::map<int, std::string> channels, schemas;
  std::vector<Seen> all;
  for (const auto& [op, place, content] :
       mcap_records(bytes, number<std::uint64_t>(bytes, footer + 9), footer)) {
    if (op == 3) schemas[number<std::uint16_t>(content, 0)] = content.substr(2);
    if (op == 4) channels[number<std::uint16_t>(content, 0)] = content;
    if (op != 8) continue;
    const auto at = number<std::uint64_t>(content, 16), length = number<std::uint64_t>(content, 24);
    const std::string chunk = bytes.substr(at + 9, length - 9);
    EXPECT_EQ(bytes[at], 6);
    const std::string records = chunk.substr(8 + 8 + 8 + 4 + 4 + 8);
    boost::crc_32_type crc;
    crc.process_bytes(records.data(), records.size());
    EXPECT_EQ(crc.checksum(), number<std::uint32_t>(chunk, 24));
    std::map<std::uint64_t, std::uint64_t> indexed;  // the time by the place
    std::size_t places_at = 32;
    const std::string places = text(content, places_at);
    for (std::size_t i = 0; i < places.size(); i += 10) {
      const auto index_at = number<std::uint64_t>(places, i + 2);
      EXPECT_EQ(bytes[index_at], 7);
      const auto entries = number<std::uint32_t>(bytes, index_at + 9 + 2);
      for (std::size_t k = 0; k < entries; k += 16)
        indexed[number<std::uint64_t>(bytes, index_at + 15 + k + 8)] =
            number<std::uint64_t>(bytes, index_at + 15 + k);
    }
    for (const auto& [where, ns] : indexed) {
      const std::string message = records.substr(where + 9, number<std::uint64_t>(records, where + 1));
      EXPECT_EQ(number<std::uint64_t>(message, 6), ns);
      const std::string& channel = channels[number<std::uint16_t>(message, 0)];
      std::size_t topic_at = 4;
      const std::string topic = text(channel, topic_at);
      all.push_back({topic, static_cast<std::int64_t>(ns), message.substr(22),
                     channel.substr(4) + schemas[number<std::uint16_t>(channel, 2)]});
    }
  }
  return all;
}

std::vector<Seen> of_database(const fs::path& path) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  sqlite3_stmt* rows = nullptr;
  sqlite3_prepare_v2(
      database,
      "SELECT name, timestamp, data, type || serialization_format || offered_qos_profiles FROM "
      "messages JOIN topics ON topics.id = topic_id ORDER BY messages.id",
      -1, &rows, nullptr);
  const auto bytes = [&](int column) {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(rows, column));
    return std::string(data, data + sqlite3_column_bytes(rows, column));
  };
  std::vector<Seen> all;
  while (sqlite3_step(rows) == SQLITE_ROW)
    all.push_back({bytes(0), sqlite3_column_int64(rows, 1), bytes(2), bytes(3)});
  sqlite3_finalize(rows);
  sqlite3_close(database);
  return all;
}

/// The header's stamp of a message of ROS 1 or of little-endian CDR.
std::int64_t stamp_ns(const std::string& bytes) {
  return number<std::uint32_t>(bytes, 4) * kSecond_ns + number<std::uint32_t>(bytes, 8);
}

/// That the messages are the same but for the stamps of the moved ones.
void expect_moved(const std::vector<Seen>& before, const std::vector<Seen>& after, std::int64_t by_ns,
                  bool same_descriptions = true) {
  ASSERT_EQ(before.size(), after.size());
  std::size_t moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    Seen expected = before[i];
    if (!same_descriptions) expected.description = after[i].description;
    if (expected.topic == "/joint_states") {
      ++moved;
      ASSERT_EQ(stamp_ns(after[i].bytes) - stamp_ns(expected.bytes), by_ns);
      expected.bytes.replace(4, 8, after[i].bytes.substr(4, 8));
    }
    ASSERT_EQ(expected, after[i]) << i;
  }
  EXPECT_GT(moved, 0U);
}

class Apply : public test::FolderTest {
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
  Result<Applied> apply(const fs::path& recording, const std::string& output,
                        const ApplyOptions& options = at_24_ms()) const {
    return apply_offset(recording, folder_ / output, options, Job());
  }
  static ApplyOptions at_24_ms() {
    ApplyOptions options;
    options.offset.offset_s = 0.024;
    return options;
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

/// A rig that stands in a room of its own time, with scans that can be placed.
fs::path turning_bag(const fs::path& path) {
  test::TestBag bag(path);
  for (int i = 0; i < 450; ++i) {
    const double stamp_s = test::kStart_s + 0.01 * i;
    bag.motor(stamp_s + 0.024);
    if (i % 3 != 0 || i < 20 || i > 420) continue;
    auto scan = test::sample_scan(stamp_s + 0.002, std::vector<float>(181, 4.0F));
    scan.angle_min = -1.57F;
    scan.angle_max = 1.57F;
    scan.angle_increment = 3.14F / 180;
    scan.time_increment = 5e-5F;
    bag.write("/scan", stamp_s + 0.030, scan);
  }
  bag.close();
  return path;
}

std::vector<Seen> of_topic(const std::vector<Seen>& all, const std::string& topic) {
  std::vector<Seen> some;
  for (const Seen& seen : all)
    if (seen.topic == topic) some.push_back(seen);
  return some;
}

TEST_F(Apply, CloudsAndTransformsComeBesideTheMessagesThatAreThere) {
  const fs::path in = turning_bag(folder_ / "in.bag");
  ApplyOptions options = at_24_ms();
  options.add.clouds_topic = "/sweeps";
  options.add.transforms = true;
  options.add.map.assume = RigKind::kStationary;
  for (const char* name : {"out.bag", "out.mcap"}) {
    const auto applied = apply(in, name, options);
    ASSERT_TRUE(applied) << applied.error().message;
    EXPECT_EQ(applied->provenance.added, (std::vector<std::string>{"/tf", "/sweeps"}));
    const bool bag = std::string(name) == "out.bag";
    const auto after = bag ? of_bag(folder_ / name) : of_mcap(folder_ / name);
    std::vector<Seen> kept;
    for (const Seen& seen : after)
      if (seen.topic != "/tf" && seen.topic != "/sweeps") kept.push_back(seen);
    expect_moved(of_bag(in), kept, -24'000'000, bag);
    EXPECT_EQ(of_topic(after, "/tf").size(), 450U);
    const auto clouds = of_topic(after, "/sweeps");
    ASSERT_GE(clouds.size(), 8U);
    std::int64_t before_ns = 0;
    for (const Seen& cloud : clouds) {
      const auto decoded = decode_cloud(Encoding::kRos1, std::as_bytes(std::span(cloud.bytes)));
      ASSERT_TRUE(decoded);
      EXPECT_GT(decoded->points(), 0U);
      EXPECT_GT(decoded->header_ns, before_ns);
      EXPECT_GT(cloud.receive_ns, decoded->header_ns);  // once it was measured
      before_ns = decoded->header_ns;
    }
  }
}

TEST_F(Apply, ATransformIsThatOfTheTrueTime) {
  ApplyOptions options = at_24_ms();
  options.add.transforms = true;
  ASSERT_TRUE(apply(turning_bag(folder_ / "in.bag"), "out.bag", options));
  std::vector<DecodedTransform> transforms;
  for (const Seen& seen : of_topic(of_bag(folder_ / "out.bag"), "/tf")) {
    ASSERT_TRUE(decode_transforms(Encoding::kRos1, std::as_bytes(std::span(seen.bytes)), transforms));
    const DecodedTransform& laser = transforms.front();
    EXPECT_EQ(laser.parent, "base_link");
    EXPECT_EQ(laser.child, "laser");
    const double since_s = static_cast<double>(laser.header_ns) * 1e-9 - test::kStart_s;
    const double angle_rad = test::sample_angle_rad(since_s + 0.024);
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitX()));
    EXPECT_LT(laser.rotation.angularDistance(expected), 1e-6);
  }
}

TEST_F(Apply, ATopicThatIsThereIsNotAddedAgain) {
  ApplyOptions options = at_24_ms();
  options.add.clouds_topic = "/words";
  const auto refused = apply(bag(), "out.bag", options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(refused.error().message.find("has a topic /words already"), std::string::npos);
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
    EXPECT_NE(twice.error().message.find("was applied to it before"), std::string::npos);
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
  EXPECT_NE(refused(in, "out.xyz").find("stands for no format"), std::string::npos);
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
