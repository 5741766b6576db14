#include "core/recording/ros2/mcap_file.hpp"

#include <cmath>

#include "core/recording/formats/read_recording.hpp"
#include "tests/core/recording/message_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

std::filesystem::path reference(const std::string& name) {
  return std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "tests/data/mcap" / (name + ".mcap");
}

constexpr std::size_t kScans = 40, kSamples = 120;

/// Files of the reference writer; see tests/data/mcap/README.md.
class ReferenceMcap : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Each, ReferenceMcap,
                         testing::Values("ros2", "ros2_lz4", "ros2_zstd", "ros2_zstd_unindexed",
                                         "ros2_unchunked", "ros1_lz4"));

TEST_P(ReferenceMcap, IsReadInFull) {
  const auto recording = read_recording(reference(GetParam()), {}, Job());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->epoch_ns, 1001'000'000'000);
  ASSERT_EQ(recording->scans.size(), kScans);
  for (std::size_t i = 0; i < kScans; ++i) {
    EXPECT_NEAR(recording->scans[i].first_beam_s, 0.025 * double(i), 1e-9);
    EXPECT_EQ(recording->ranges(recording->scans[i])[3], 4);
    const float last_m = recording->ranges(recording->scans[i])[4];
    EXPECT_TRUE(i <= 25 ? last_m == float(5 + i) : std::isnan(last_m)) << i;
    EXPECT_EQ(recording->intensities[5 * i], float(i));
  }
  EXPECT_EQ(recording->scans[0].beams, 5U);
  EXPECT_EQ(recording->scans[0].angle_min_rad, -0.5);
  EXPECT_EQ(recording->report.out_of_range_ranges, 14U);  // beyond 30 m
  ASSERT_EQ(recording->motor.time_s.size(), kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    EXPECT_NEAR(recording->motor.time_s[i], 0.01 * double(i) - 0.1, 1e-9);
    EXPECT_EQ(recording->motor.angle_rad[i], 0.01 * double(i));
  }
  EXPECT_EQ(recording->rig.motor.joint, "roll_motor");
  EXPECT_NEAR(*recording->report.laser_stamps.receive_minus_header_s, 0.005, 1e-12);
  EXPECT_EQ(recording->report.warnings, std::vector<std::string>());
  const bool ros1 = GetParam().starts_with("ros1");
  EXPECT_EQ(recording->report.topics[1].type, ros1 ? "sensor_msgs/LaserScan" : "sensor_msgs/msg/LaserScan");
}

TEST_P(ReferenceMcap, CutAnywhereItIsReadAsFarAsItGoesWithAWarning) {
  const test::ScratchFolder folder;
  const std::string whole = test::contents_of(reference(GetParam()));
  std::size_t scans_before = 0;
  for (std::size_t bytes = 1; bytes + 8 < whole.size(); bytes += 97) {
    test::write_file(folder / "cut.mcap", whole.substr(0, bytes));
    const auto recording = read_recording(folder / "cut.mcap", {}, Job());
    if (!recording) {
      EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput) << "cut at " << bytes;
      continue;
    }
    EXPECT_FALSE(recording->report.warnings.empty()) << "cut at " << bytes;
    EXPECT_GE(recording->scans.size(), scans_before) << "cut at " << bytes;
    scans_before = recording->scans.size();
  }
  EXPECT_EQ(scans_before, kScans);
}

TEST_P(ReferenceMcap, AnyDamagedByteNeverDoesWorseThanARefusal) {
  const test::ScratchFolder folder;
  const std::string whole = test::contents_of(reference(GetParam()));
  for (std::size_t at = 0; at < whole.size(); at += 127) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    test::write_file(folder / "a.mcap", damaged);
    const auto recording = read_recording(folder / "a.mcap", {}, Job());
    if (!recording) {
      EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput) << at;
    }
  }
}

/// Records as their specification says, independently of the program's own writer.
struct RawMcap {
  static std::string number(std::uint64_t value, int bytes) { return test::RawBag::number(value, bytes); }
  static std::string text(const std::string& text) { return number(text.size(), 4) + text; }
  static std::string record(int op, const std::string& content) {
    return std::string(1, static_cast<char>(op)) + number(content.size(), 8) + content;
  }
  static std::string magic() { return "\x89MCAP0\r\n"; }
  static std::string schema(int id, const std::string& name) {
    return record(3, number(id, 2) + text(name) + text("ros2msg") + text(""));
  }
  static std::string channel(int id, int schema, const std::string& topic,
                             const std::string& encoding = "cdr") {
    return record(4, number(id, 2) + number(schema, 2) + text(topic) + text(encoding) + number(0, 4));
  }
  static std::string message(int channel, std::uint64_t log_ns, const std::string& data) {
    return record(5, number(channel, 2) + number(0, 4) + number(log_ns, 8) + number(log_ns, 8) + data);
  }
  static std::string chunk(const std::string& compression, std::uint64_t claimed_bytes, std::uint32_t crc,
                           const std::string& records) {
    return record(6, number(0, 16) + number(claimed_bytes, 8) + number(crc, 4) + text(compression) +
                         number(records.size(), 8) + records);
  }
  static std::string end() { return record(15, number(0, 4)) + record(2, number(0, 20)) + magic(); }

  /// 4 scans and 8 samples of a motor, as records.
  static std::string records() {
    std::string all = schema(1, "sensor_msgs/msg/LaserScan") + channel(1, 1, "/scan") +
                      schema(2, "std_msgs/msg/Float64") + channel(2, 2, "/angle");
    for (std::uint32_t i = 0; i < 4; ++i)
      all += message(1, 1'000'000'000ULL * (10 + i),
                     test::scan_bytes(test::MessageBytes::kCdr, 10 + i, 0, {1, 2, 3}));
    for (std::uint32_t i = 0; i < 8; ++i)
      all += message(2, 1'000'000'000ULL * (8 + i),
                     test::MessageBytes(test::MessageBytes::kCdr).number(0.1 * i).bytes());
    return all;
  }
};

class DamagedMcap : public testing::Test {
 protected:
  Result<Recording> read(const std::string& bytes) const {
    test::write_file(folder_ / "a.mcap", bytes);
    return read_recording(folder_ / "a.mcap", {}, Job());
  }
  void expect_warning(const std::string& bytes, const std::string& wanted, std::size_t scans = 4) const {
    const auto recording = read(bytes);
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(recording->scans.size(), scans);
    for (const std::string& warning : recording->report.warnings)
      if (warning.find(wanted) != std::string::npos) return;
    ADD_FAILURE() << wanted << " is not in " << testing::PrintToString(recording->report.warnings);
  }
  std::string refusal(const std::string& bytes) const {
    const auto recording = read(bytes);
    if (recording) return "accepted";
    EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput);
    return recording.error().message.substr(recording.error().message.find("a.mcap"));
  }

  test::ScratchFolder folder_;
};

TEST_F(DamagedMcap, ASoundFileOfOurOwnMakingIsRead) {
  const auto recording = read(RawMcap::magic() + RawMcap::records() + RawMcap::end());
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->scans.size(), 4U);
  EXPECT_EQ(recording->motor.time_s.size(), 8U);
  EXPECT_EQ(recording->rig.motor.joint, "data");
}

TEST_F(DamagedMcap, AFileThatWasNeverClosedIsReadWithAWarning) {
  expect_warning(RawMcap::magic() + RawMcap::records(), "never closed (it has no footer)");
}

TEST_F(DamagedMcap, AChunkWithAWrongChecksumIsSkipped) {
  const std::string records = RawMcap::records();
  const std::string lost = RawMcap::message(1, 5, test::scan_bytes(test::MessageBytes::kCdr, 99, 0, {1}));
  expect_warning(RawMcap::magic() + records + RawMcap::chunk("", lost.size(), 12345, lost) + RawMcap::end(),
                 "does not have the checksum that it claims, and was skipped");
}

TEST_F(DamagedMcap, AnUnknownCompressionIsSkipped) {
  expect_warning(
      RawMcap::magic() + RawMcap::records() + RawMcap::chunk("snappy", 4, 0, "abcd") + RawMcap::end(),
      "compressed as \"snappy\", which is not lz4 or zstd");
}

TEST_F(DamagedMcap, DamagedCompressedChunksAreNamed) {
  for (const char* compression : {"lz4", "zstd"})
    expect_warning(RawMcap::magic() + RawMcap::records() +
                       RawMcap::chunk(compression, 100, 0, std::string(100, '\x55')) + RawMcap::end(),
                   "is damaged (its ");
}

TEST_F(DamagedMcap, SizesThatTheFileDoesNotHoldAreNotBelieved) {
  const std::string sound = RawMcap::magic() + RawMcap::records();
  for (const std::uint64_t claimed : {std::uint64_t{1} << 20, std::uint64_t{1} << 40, UINT64_MAX}) {
    for (const char op : {'\x03', '\x04', '\x05', '\x06', '\x09', '\x42'}) {
      const std::string record = std::string(1, op) + RawMcap::number(claimed, 8) + std::string(40, 'x');
      expect_warning(sound + record, "it is cut short at byte");
    }
  }
  expect_warning(
      sound + RawMcap::record(6, std::string(28, '\0') + RawMcap::number(0xFFFFFFFF, 4)) + RawMcap::end(),
      "is damaged and was skipped");
  expect_warning(
      sound + RawMcap::record(4, RawMcap::number(9, 2) + RawMcap::number(0xFFFFFFFFFF, 8)) + RawMcap::end(),
      "the channel at byte");
}

TEST_F(DamagedMcap, AWrongLengthInAFileThatIsNotCutShortIsCalledThat) {
  const std::string sound = RawMcap::magic() + RawMcap::records();
  for (const char op : {'\x05', '\x06', '\x09'}) {
    const std::string record = std::string(1, op) + RawMcap::number(1 << 20, 8) + std::string(40, 'x');
    const std::string bytes = sound + record + RawMcap::end();
    expect_warning(bytes, "the length of the record at byte " + std::to_string(sound.size()) +
                              " is damaged: it claims 1048576 bytes");
    const auto recording = read(bytes);
    for (const std::string& warning : recording->report.warnings)
      EXPECT_EQ(warning.find("it is cut short"), std::string::npos) << warning;
  }
}

TEST_F(DamagedMcap, AWrongOpCodeIsCalledThat) {
  const std::string sound = RawMcap::magic() + RawMcap::records();
  const std::string place = "the record at byte " + std::to_string(sound.size());
  expect_warning(sound + RawMcap::record(0x45, "lost") + RawMcap::end(), place + " has op code 0x45");
  const std::string chunk = RawMcap::chunk("", 4, 0, "lost");
  for (const char op : {'\x07', '\x0f'})
    expect_warning(sound + op + chunk.substr(1) + RawMcap::end(), place + " is damaged, and was skipped");
  const std::string within = RawMcap::record(0x25, "lost");
  expect_warning(
      sound + RawMcap::chunk("", within.size(), 0, within) + RawMcap::end(),
      "the record at byte 0 of the chunk at byte " + std::to_string(sound.size()) + " has op code 0x25");
  const auto without = read(sound + RawMcap::record(0x80, "of another program") + RawMcap::end());
  ASSERT_TRUE(without);
  for (const std::string& warning : without->report.warnings)
    EXPECT_EQ(warning.find("op code"), std::string::npos) << "from 0x80 on they are free: " << warning;
}

TEST_F(DamagedMcap, ADamagedFooterIsCalledThat) {
  std::string end = RawMcap::end();
  end[end.size() - RawMcap::magic().size() - 29] = '\x0c';
  expect_warning(RawMcap::magic() + RawMcap::records() + end, "its footer is damaged");
}

TEST_F(DamagedMcap, MessagesOfNoChannelAreCounted) {
  std::string bytes = RawMcap::magic() + RawMcap::records();
  for (int i = 0; i < 3; ++i) bytes += RawMcap::message(77, 1, "x");
  expect_warning(bytes + RawMcap::end(), "3 messages belong to no channel");
}

TEST_F(DamagedMcap, OtherEncodingsAreNotUsed) {
  const std::string bytes = RawMcap::magic() + RawMcap::schema(1, "sensor_msgs/msg/LaserScan") +
                            RawMcap::channel(1, 1, "/scan", "json") + RawMcap::message(1, 1, "{}") +
                            RawMcap::end();
  EXPECT_NE(refusal(bytes).find("no sensor_msgs/LaserScan"), std::string::npos) << refusal(bytes);
}

TEST_F(DamagedMcap, AnotherVersionIsRefused) {
  EXPECT_EQ(refusal("\x89MCAP1\r\nabcdefghijk").substr(0, 42), "a.mcap: is an MCAP file of an unknown vers");
}

TEST_F(DamagedMcap, ADamagedFirstChunkCostsOnlyItself) {
  std::string bytes = test::contents_of(reference("ros2"));
  const std::size_t chunk = bytes.find("/joint_states") + 500;  // within the first chunk's messages
  bytes[chunk] = static_cast<char>(~bytes[chunk]);
  const auto recording = read(bytes);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_GT(recording->scans.size(), kScans / 2);
  EXPECT_LT(recording->scans.size(), kScans);
  ASSERT_EQ(recording->report.warnings.size(), 1U);
  EXPECT_NE(recording->report.warnings[0].find("checksum"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
