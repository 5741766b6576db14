#include "core/recording/messages/point_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/recording/cloud_bytes.hpp"

namespace sweepscope {
namespace {

using test::as_span, test::CloudBytes, test::CloudType, test::MessageBytes;

constexpr double kStep_s = 1e-4, kStep_rad = 0.01;

/// A ring's point that was fired `beam` steps after the cloud's first.
void add(CloudBytes& cloud, int beam, double time, double elevation_rad = 0, std::uint16_t ring = 0,
         double range_m = 5) {
  const double azimuth = -3 + beam * kStep_rad;
  cloud.point(static_cast<float>(range_m * std::cos(elevation_rad) * std::cos(azimuth)),
              static_cast<float>(range_m * std::cos(elevation_rad) * std::sin(azimuth)),
              static_cast<float>(range_m * std::sin(elevation_rad)), time, ring);
}

RawLaser read(const std::string& message, Encoding encoding = Encoding::kCdr) {
  CloudReader reader;
  RawLaser laser;
  EXPECT_TRUE(reader.add(encoding, as_span(message), 77, laser)) << reader.problem();
  return laser;
}

TEST(PointCloud, ARingBecomesALineWithItsMissingBeamsInPlace) {
  for (const auto form : {MessageBytes::kRos1, MessageBytes::kCdr, MessageBytes::kCdrBigEndian}) {
    CloudBytes cloud("time", CloudType::kFloat32, true);
    for (const std::uint16_t ring : {std::uint16_t{1}, std::uint16_t{0}})
      for (int beam = 0; beam < 40; ++beam)
        if (beam != 7 && beam != 8) add(cloud, beam, beam * kStep_s, ring * 0.2 - 0.1, ring, 5 + beam);
    const RawLaser laser =
        read(cloud.message(form, 12, 5), form == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr);
    ASSERT_EQ(laser.scans.size(), 2U);
    EXPECT_EQ(laser.frame, "lidar");
    for (std::uint16_t ring = 0; ring < 2; ++ring) {
      const RawScan& line = laser.scans[ring];
      EXPECT_EQ(line.ring, ring);
      EXPECT_EQ(line.stamps.header_ns, 12'000'000'005);
      EXPECT_EQ(line.stamps.receive_ns, 77);
      EXPECT_NEAR(line.time_increment_s, kStep_s, 1e-9);
      EXPECT_NEAR(line.angle_increment_rad, kStep_rad, 1e-5);
      EXPECT_NEAR(line.cloud_end_after_stamp_s, 39 * kStep_s, 1e-7);
      // Beams before the first that returned something belong to the turn as well: 0.1 rad of them.
      const std::size_t before = line.beams - 40;
      EXPECT_EQ(before, 10U);
      EXPECT_NEAR(line.first_beam_after_stamp_s, -10 * kStep_s, 1e-7);
      for (std::size_t beam = 0; beam < 40; ++beam) {
        const float range_m = laser.ranges_m[line.first_range + before + beam];
        if (beam == 7 || beam == 8) {
          EXPECT_TRUE(std::isnan(range_m));
          continue;
        }
        EXPECT_NEAR(range_m, 5 + double(beam), 1e-4);
        const Eigen::Vector3f& direction = laser.directions[line.first_range + before + beam];
        EXPECT_NEAR(direction.z(), std::sin(ring * 0.2 - 0.1), 1e-6);
        EXPECT_NEAR(std::atan2(direction.y(), direction.x()), -3 + double(beam) * kStep_rad, 1e-5);
      }
    }
  }
}

TEST(PointCloud, ARingThatSeesTheSkyOverMostOfATurnKeepsItsAngles) {
  CloudBytes cloud("time", CloudType::kFloat32, true);
  for (int beam = 0; beam < 480; ++beam)
    if (beam < 60 || beam >= 420) add(cloud, beam, beam * kStep_s);  // 3.6 rad without a return
  const RawLaser laser = read(cloud.message(MessageBytes::kCdr, 12, 0));
  ASSERT_EQ(laser.scans.size(), 1U);
  EXPECT_NEAR(laser.scans[0].angle_increment_rad, kStep_rad, 1e-5);
  EXPECT_EQ(laser.scans[0].beams, 480U + 10U);
}

TEST(PointCloud, TurnsBeginWithTheFirstPointOfAnyRing) {
  CloudBytes cloud("time", CloudType::kFloat32, true);
  for (int beam = 250; beam < 480; ++beam) add(cloud, beam, beam * kStep_s, 0.1, 0);
  for (int beam = 0; beam < 480; ++beam) add(cloud, beam, beam * kStep_s, -0.1, 1);
  const RawLaser laser = read(cloud.message(MessageBytes::kCdr, 12, 0));
  ASSERT_EQ(laser.scans.size(), 2U);
  for (const RawScan& line : laser.scans) {
    EXPECT_EQ(line.beams, 480U + 10U);
    EXPECT_NEAR(line.first_beam_after_stamp_s, -10 * kStep_s, 1e-7);
  }
}

TEST(PointCloud, LinesOfARingBeginAtOneAzimuthWhateverReturned) {
  CloudReader reader;
  RawLaser laser;
  for (const int first : {0, 3, 25}) {
    CloudBytes cloud("time", CloudType::kFloat32, true);
    for (int beam = first; beam < 200; ++beam) add(cloud, beam, beam * kStep_s);
    const std::string message = cloud.message(MessageBytes::kCdr, 12, 0);
    ASSERT_TRUE(reader.add(Encoding::kCdr, as_span(message), 0, laser));
  }
  for (const RawScan& line : laser.scans) {
    EXPECT_NEAR(line.angle_min_rad, laser.scans[0].angle_min_rad, 0.6 * kStep_rad);
    EXPECT_NEAR(line.first_beam_after_stamp_s, laser.scans[0].first_beam_after_stamp_s, 1.1 * kStep_s);
  }
}

struct Unit {
  const char* name;
  CloudType type;
  double first, per_s;
  std::int64_t stamp_ns;  // of the first point
};

class CloudUnits : public testing::TestWithParam<Unit> {};
INSTANTIATE_TEST_SUITE_P(
    OfDrivers, CloudUnits,
    testing::Values(Unit{"t", CloudType::kUint32, 0, 1e9, 12'000'000'000},            // Ouster
                    Unit{"time", CloudType::kFloat32, 0, 1, 12'000'000'000},          // Velodyne
                    Unit{"time", CloudType::kFloat32, -0.1, 1, 11'900'000'000},       // since the end
                    Unit{"time", CloudType::kFloat32, 0, 1e6, 12'000'000'000},        // Livox, us
                    Unit{"t", CloudType::kUint32, 0, 1e6, 12'000'000'000},            // whole us
                    Unit{"offset_time", CloudType::kUint32, 0, 1e9, 12'000'000'000},  // Livox
                    Unit{"timestamp", CloudType::kFloat64, 1.7e9, 1, 1'700'000'000'000'000'000},  // Hesai
                    Unit{"timestamp", CloudType::kFloat64, 1.7e18, 1e9,
                         1'700'000'000'000'000'000}));  // Livox

TEST_P(CloudUnits, AreRead) {
  const Unit& unit = GetParam();
  CloudBytes cloud(unit.name, unit.type, true);
  for (int beam = 0; beam < 1000; ++beam) add(cloud, beam, unit.first + beam * kStep_s * unit.per_s);
  const RawLaser laser = read(cloud.message(MessageBytes::kCdr, 12, 0));
  ASSERT_EQ(laser.scans.size(), 1U);
  const RawScan& line = laser.scans[0];
  EXPECT_NEAR(line.time_increment_s, kStep_s, 1e-6);
  const double first_s = double(line.stamps.header_ns - unit.stamp_ns) * 1e-9 + line.first_beam_after_stamp_s;
  EXPECT_NEAR(first_s + (line.beams - 1000) * kStep_s, 0, 1e-6);
  EXPECT_NEAR(line.cloud_end_after_stamp_s - line.first_beam_after_stamp_s, (line.beams - 1) * kStep_s, 2e-6);
}

TEST(PointCloud, WithoutRingsALineIsASliceOfTime) {
  CloudBytes cloud("t", CloudType::kUint32, false);
  for (int beam = 0; beam < 300; ++beam) add(cloud, beam, beam * 1e5);
  const RawLaser laser = read(cloud.message(MessageBytes::kCdr, 12, 0));
  ASSERT_EQ(laser.scans.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(laser.scans[i].beams, 100U);
    EXPECT_EQ(laser.scans[i].ring, i);  // told apart by their place in the cloud
    EXPECT_NEAR(laser.scans[i].first_beam_after_stamp_s, 0.01 * double(i), 1e-9);
    EXPECT_NEAR(laser.scans[i].angle_increment_rad, kStep_rad, 1e-5);
  }
}

TEST(PointCloud, RingsThatDoNotGoRoundAreCutIntoSlices) {
  CloudBytes cloud("offset_time", CloudType::kUint32, true);
  for (int i = 0; i < 300; ++i)
    for (const std::uint16_t ring : {std::uint16_t{0}, std::uint16_t{1}})
      add(cloud, i % 100 < 50 ? i % 50 : 50 - i % 50, i * 1e5, ring * 0.1, ring);  // to and fro
  const RawLaser laser = read(cloud.message(MessageBytes::kCdr, 12, 0));
  ASSERT_EQ(laser.scans.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const RawScan& line = laser.scans[i];
    EXPECT_EQ(line.beams, 100U);
    EXPECT_EQ(line.ring, i / 3 * 64 + i % 3);
    EXPECT_NEAR(line.first_beam_after_stamp_s, 0.01 * double(i % 3), 1e-9);
    EXPECT_NEAR(line.angle_increment_rad, kStep_rad, 0.05 * kStep_rad);  // along the path
  }
}

TEST(PointCloud, CloudsWithoutTimesAreOfNoUseAndItIsSaid) {
  CloudReader reader;
  RawLaser laser;
  CloudBytes still("t", CloudType::kUint32, true), nameless("when", CloudType::kUint32, true);
  for (int beam = 0; beam < 10; ++beam) {
    add(still, beam, 0);
    add(nameless, beam, beam);
  }
  EXPECT_FALSE(reader.add(Encoding::kCdr, as_span(still.message(MessageBytes::kCdr, 1, 0)), 0, laser));
  EXPECT_EQ(reader.problem(), "its points all have the same time");
  EXPECT_FALSE(reader.add(Encoding::kCdr, as_span(nameless.message(MessageBytes::kCdr, 1, 0)), 0, laser));
  EXPECT_NE(reader.problem().find("its points have no times"), std::string::npos);
  EXPECT_TRUE(laser.scans.empty());
}

TEST(PointCloud, BeamsThatNoFieldTellsApartAreNoLine) {
  for (const bool at_once : {true, false}) {
    CloudBytes cloud("t", CloudType::kUint32, false);
    for (int beam = 0; beam < 300; ++beam)
      add(cloud, beam, (at_once ? beam / 3 : beam) * 1e5, beam % 3 * (at_once ? 0.03 : 0.3));
    CloudReader reader;
    RawLaser laser;
    EXPECT_FALSE(reader.add(Encoding::kCdr, as_span(cloud.message(MessageBytes::kCdr, 1, 0)), 0, laser));
    EXPECT_NE(reader.problem().find("no field for the beam"), std::string::npos) << reader.problem();
    EXPECT_TRUE(laser.scans.empty());
  }
}

TEST(PointCloud, PointsThatAreNotNumbersAreLeftOut) {
  CloudBytes cloud("time", CloudType::kFloat32, true);
  const float nan = std::nanf("");
  for (int beam = 0; beam < 40; ++beam) {
    if (beam % 4 == 1) cloud.point(nan, nan, nan, beam * kStep_s);
    if (beam % 4 == 2) cloud.point(0, 0, 0, beam * kStep_s);
    if (beam % 4 == 3) cloud.point(1, 1, 1, nan);
    if (beam % 4 == 0 || beam == 1) add(cloud, beam, beam * kStep_s);
  }
  const RawLaser laser = read(cloud.message(MessageBytes::kCdr, 12, 0));
  ASSERT_EQ(laser.scans.size(), 1U);
  for (const float range_m : laser.ranges_m)
    EXPECT_TRUE(std::isnan(range_m) || std::abs(range_m - 5) < 1e-4) << range_m;
}

/// A message whose sizes are as given, with room for ten points of 16 bytes.
std::string cloud_of_sizes(std::uint32_t height, std::uint32_t width, std::uint32_t row_bytes,
                           std::uint32_t time_offset) {
  MessageBytes message(MessageBytes::kRos1);
  message.header(12, 0, "lidar").number(height).number(width).number(std::uint32_t{4});
  const auto field = [&](const char* name, std::uint32_t offset, std::uint8_t type) {
    message.text(name).number(offset).number(type).number(std::uint32_t{1});
  };
  field("x", 0, 7);
  field("y", 4, 7);
  field("z", 8, 7);
  field("t", time_offset, 6);
  message.number(std::uint8_t{0}).number(std::uint32_t{16}).number(row_bytes);
  return message.array(std::vector<std::uint8_t>(160, 1)).number(std::uint8_t{1}).bytes();
}

TEST(PointCloud, SizesThatDoNotFitTheDataAreMalformed) {
  const auto whole = [](std::uint32_t height, std::uint32_t width, std::uint32_t row_bytes,
                        std::uint32_t time_offset) {
    const std::string message = cloud_of_sizes(height, width, row_bytes, time_offset);
    return decode_cloud(Encoding::kRos1, as_span(message)).has_value();
  };
  constexpr std::uint32_t kHuge = 0xFFFFFFFF;
  EXPECT_TRUE(whole(1, 10, 160, 12));
  EXPECT_TRUE(whole(1, 10, 0, 12));  // of one row some drivers leave it at 0
  EXPECT_TRUE(whole(2, 5, 80, 12));
  EXPECT_TRUE(whole(0, 0, 0, 12));
  EXPECT_FALSE(whole(1, 11, 160, 12));
  EXPECT_FALSE(whole(2, 10, 160, 12));
  EXPECT_FALSE(whole(kHuge, 1, 0, 12));  // rows that overlap
  EXPECT_FALSE(whole(2, 5, 64, 12));
  EXPECT_FALSE(whole(kHuge, kHuge, kHuge, 12));
  EXPECT_FALSE(whole(1, kHuge, 160, 12));
  EXPECT_FALSE(whole(1, 10, 160, 13));
  EXPECT_FALSE(whole(1, 10, 160, kHuge));
}

TEST(PointCloud, EveryCutMessageAndAnyLyingSizeIsMalformed) {
  CloudBytes cloud("t", CloudType::kUint32, true);
  for (int beam = 0; beam < 10; ++beam) add(cloud, beam, beam * 1e5);
  const std::string message = cloud.message(MessageBytes::kRos1, 12, 0);
  ASSERT_TRUE(decode_cloud(Encoding::kRos1, as_span(message)));
  for (std::size_t n = 0; n < message.size(); ++n)
    EXPECT_FALSE(decode_cloud(Encoding::kRos1, as_span(message).first(n))) << n;
  // A number of the message replaced by 2^32 - 1: no read outside the message, no great allocation.
  for (std::size_t at = 0; at + 4 <= message.size() - std::size_t{10} * cloud.point_bytes(); ++at) {
    std::string lying = message;
    lying.replace(at, 4, 4, '\xff');
    CloudReader reader;
    RawLaser laser;
    reader.add(Encoding::kRos1, as_span(lying), 0, laser);
    EXPECT_LT(laser.ranges_m.size(), 100'000U);
  }
}

}  // namespace
}  // namespace sweepscope
