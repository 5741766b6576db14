// Clouds of Livox scanners, on bytes that are made from the message definitions of their two drivers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/recording/messages/message_collector.hpp"
#include "tests/core/recording/cloud_bytes.hpp"

namespace sweepscope {
namespace {

using test::as_span, test::LivoxBytes, test::MessageBytes;

constexpr std::uint32_t kStep_ns = 100'000;
constexpr double kLineStep_rad = 0.01;

/// The point of a line that was fired `beam` steps after the base time, `range_m` away.
LivoxBytes::Point point(int beam, std::uint8_t line = 0, double range_m = 5) {
  const double azimuth = -1 + beam * kLineStep_rad, elevation = line * 0.1;
  return {static_cast<float>(range_m * std::cos(elevation) * std::cos(azimuth)),
          static_cast<float>(range_m * std::cos(elevation) * std::sin(azimuth)),
          static_cast<float>(range_m * std::sin(elevation)), static_cast<std::uint32_t>(beam) * kStep_ns,
          line};
}

/// A cloud of two lines that take 6 ms.
LivoxBytes two_lines() {
  LivoxBytes cloud;
  for (int beam = 0; beam < 60; ++beam)
    for (const std::uint8_t line : {std::uint8_t{0}, std::uint8_t{1}})
      cloud.point(point(beam, line, 5 + beam));
  return cloud;
}

Encoding encoding_of(MessageBytes::Form form) {
  return form == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr;
}

/// What a file with one message of this type holds.
RawRecording collected(const std::string& message, MessageBytes::Form form = MessageBytes::kCdr,
                       const std::string& type = "livox_ros_driver2/msg/CustomMsg",
                       const std::string& md5sum = "*", CloudDetail detail = CloudDetail::kLines) {
  RawRecording raw;
  raw.name = "a recording";
  const Rig rig;
  MessageCollector collector(rig, raw, detail);
  const std::size_t topic = collector.number_of({"/livox/lidar", type, encoding_of(form), true, md5sum});
  EXPECT_FALSE(collector.add(topic, 77, as_span(message), [] { return std::string("message 1"); }));
  collector.finish();
  return raw;
}

TEST(Livox, BothDriversAndEverySerialisationGiveTheSameLines) {
  constexpr const char* kMd5 = "e4d6829bdfe657cb6c21a746c86b21a6";
  for (const char* package : {"livox_ros_driver", "livox_ros_driver2"}) {
    for (const auto form : {MessageBytes::kRos1, MessageBytes::kCdr, MessageBytes::kCdrBigEndian}) {
      const bool ros1 = form == MessageBytes::kRos1;
      const RawRecording raw =
          collected(two_lines().message(form, 12, 5, 0), form,
                    std::string(package) + (ros1 ? "/CustomMsg" : "/msg/CustomMsg"), ros1 ? kMd5 : "*");
      ASSERT_EQ(raw.lasers.size(), 1U);
      EXPECT_TRUE(raw.warnings.empty());
      const RawLaser& laser = raw.lasers[0];
      EXPECT_TRUE(laser.of_clouds);
      EXPECT_TRUE(laser.has_intensities);
      EXPECT_EQ(laser.frame, "livox_frame");
      ASSERT_EQ(laser.scans.size(), 2U);
      for (std::uint16_t line = 0; line < 2; ++line) {
        const RawScan& scan = laser.scans[line];
        EXPECT_EQ(scan.ring, line);
        EXPECT_EQ(scan.stamps.header_ns, 12'000'000'005);
        EXPECT_EQ(scan.stamps.receive_ns, 77);
        EXPECT_NEAR(scan.time_increment_s, kStep_ns * 1e-9, 1e-10);
        EXPECT_NEAR(scan.cloud_end_after_stamp_s, 59 * kStep_ns * 1e-9, 1e-12);
        const std::size_t before = scan.beams - 60;
        for (std::size_t beam = 0; beam < 60; ++beam) {
          const std::size_t at = scan.first_range + before + beam;
          EXPECT_NEAR(laser.ranges_m[at], 5 + double(beam), 1e-4);
          EXPECT_NEAR(laser.directions[at].z(), std::sin(line * 0.1), 1e-6);
          EXPECT_EQ(laser.intensities[at], 40);
        }
      }
    }
  }
}

TEST(Livox, TheStampIsTheBaseTimeWhereThatCountsSince1970) {
  const auto stamp = [](std::uint64_t base_ns) {
    const RawRecording raw = collected(two_lines().message(MessageBytes::kCdr, 12, 5, base_ns));
    return raw.lasers.at(0).scans.at(0).stamps.header_ns;
  };
  EXPECT_EQ(stamp(1'700'000'000'123'456'789), 1'700'000'000'123'456'789);
  EXPECT_EQ(stamp(98'765'432'100), 12'000'000'005);  // since the scanner was switched on
  EXPECT_EQ(stamp(std::numeric_limits<std::uint64_t>::max()), 12'000'000'005);
}

TEST(Livox, PointsWithoutARangeAndThoseTaggedAsNoiseAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  LivoxBytes cloud;
  for (int beam = 0; beam < 60; ++beam) {
    LivoxBytes::Point p = point(beam);
    if (beam == 10) p.x = p.y = p.z = 0;
    if (beam == 20) p.y = kNan;
    if (beam == 30) p.tag = 0x01;  // noise by where it lies
    if (beam == 40) p.tag = 0x04;  // noise by its intensity
    if (beam == 50) p.tag = 0x10;  // a return, and no noise
    cloud.point(p);
  }
  const RawRecording raw = collected(cloud.message(MessageBytes::kCdr, 12, 0, 0));
  const RawScan& scan = raw.lasers.at(0).scans.at(0);
  const std::size_t first = scan.first_range + scan.beams - 60;
  for (std::size_t beam = 0; beam < 60; ++beam) {
    const bool left_out = beam % 10 == 0 && beam >= 10 && beam <= 40;
    EXPECT_EQ(std::isnan(raw.lasers[0].ranges_m[first + beam]), left_out) << beam;
  }
}

TEST(Livox, DamagedMessagesAreMalformedAndNothingIsTaken) {
  for (const auto form : {MessageBytes::kRos1, MessageBytes::kCdr}) {
    const std::string whole = two_lines().message(form, 12, 0, 0);
    const std::string ros1_type = "livox_ros_driver/CustomMsg";
    for (std::size_t length = 0; length < whole.size(); length += 7) {
      const RawRecording raw = collected(whole.substr(0, length), form, ros1_type);
      EXPECT_TRUE(raw.lasers.at(0).scans.empty()) << length;
      EXPECT_EQ(raw.topics.at(0).malformed, 1U) << length;
    }
    // More points than the message holds, up to more than any memory does; and fewer.
    for (const std::uint32_t count : {121U, 1'000'000U, 0xffffffffU, 119U, 0U}) {
      const RawRecording raw = collected(two_lines().message(form, 12, 0, 0, count), form, ros1_type);
      EXPECT_TRUE(raw.lasers.at(0).scans.empty()) << count;
      EXPECT_EQ(raw.topics.at(0).malformed, 1U) << count;
    }
  }
}

TEST(Livox, ACloudOfNanOrOfNothingHasNoLines) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  LivoxBytes cloud;
  for (std::uint32_t i = 0; i < 60; ++i) cloud.point({kNan, kNan, kNan, i * kStep_ns});
  for (const LivoxBytes& of_nothing : {cloud, LivoxBytes()}) {
    const RawRecording raw = collected(of_nothing.message(MessageBytes::kCdr, 12, 0, 0));
    EXPECT_TRUE(raw.lasers.at(0).scans.empty());
    EXPECT_EQ(raw.topics.at(0).malformed, 0U);
  }
}

TEST(Livox, AnotherVersionOfTheMessageIsNotUsedAndItIsSaid) {
  const RawRecording raw = collected(two_lines().message(MessageBytes::kRos1, 12, 0, 0), MessageBytes::kRos1,
                                     "livox_ros_driver/CustomMsg", "0123456789abcdef0123456789abcdef");
  EXPECT_TRUE(raw.lasers.empty());
  ASSERT_EQ(raw.warnings.size(), 1U);
  EXPECT_NE(raw.warnings[0].find("another version of livox_ros_driver/CustomMsg"), std::string::npos);
}

TEST(Livox, KeptWholeItIsACloudWithTheSameNumbers) {
  for (const auto form : {MessageBytes::kRos1, MessageBytes::kCdr}) {
    const RawRecording raw = collected(two_lines().message(form, 12, 0, 0), form,
                                       "livox_ros_driver2/CustomMsg", "*", CloudDetail::kWhole);
    ASSERT_EQ(raw.lasers.at(0).clouds.size(), 1U);
    const RawCloud& cloud = raw.lasers[0].clouds[0];
    EXPECT_EQ(cloud.width, 120U);
    EXPECT_EQ(cloud.data.size(), std::size_t{cloud.height} * cloud.row_bytes);
    ASSERT_EQ(cloud.fields.size(), 7U);
    EXPECT_EQ(cloud.fields[0].name, "offset_time");
    EXPECT_EQ(cloud.fields[6].name, "line");
  }
}

}  // namespace
}  // namespace sweepscope
