// Clouds as a recording: written in every format that has them, and damaged.
#include <gtest/gtest.h>

#include <cstring>

#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "tests/core/cloud_bench.hpp"
#include "tests/core/recording/cloud_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"

namespace sweepscope {
namespace {

using test::CloudBench, test::MessageBytes;

CloudBench short_bench() {
  CloudBench bench;
  bench.rings = 4;
  bench.beams = 200;
  bench.duration_s = 1.5;
  return bench;
}

class CloudForms : public testing::Test {
 protected:
  std::filesystem::path write(const RawRecording& raw, const char* name, RecordingFormat format,
                              const char* compression = "none") const {
    const auto written =
        write_recording(raw.lasers.at(0), raw.joints.at(0), format, compression, folder_ / name, Job());
    EXPECT_TRUE(written) << written.error().message;
    return folder_ / name;
  }
  /// What reading a recording with these clouds and a turning motor fails with.
  std::string refusal(const std::vector<std::string>& clouds) const {
    const std::filesystem::path path = folder_ / "damaged.db3";
    std::filesystem::remove(path);
    {
      test::TestDatabase database(path);
      database.topic(1, "/points", "sensor_msgs/msg/PointCloud2");
      database.topic(2, "/joint_states", "sensor_msgs/msg/JointState");
      std::int64_t receive_ns = 1'000'000'000;
      for (const std::string& cloud : clouds) database.message(1, receive_ns += 100'000'000, cloud);
      for (std::uint32_t i = 0; i < 100; ++i)
        database.message(2, 1'000'000'000 + i * 10'000'000,
                         test::joint_bytes(MessageBytes::kCdr, 1, i * 10'000'000, {"tilt"}, {0.01 * i}));
    }
    const auto recording = read_recording(path, {}, Job());
    EXPECT_FALSE(recording);
    if (recording) return "";
    EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput);
    return recording.error().message;
  }
  test::ScratchFolder folder_;
};

void expect_same(const Recording& a, const Recording& b) {
  EXPECT_EQ(a.epoch_ns, b.epoch_ns);
  ASSERT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t i = 0; i < a.scans.size(); ++i) {
    EXPECT_EQ(a.scans[i].first_beam_s, b.scans[i].first_beam_s);
    EXPECT_EQ(a.scans[i].time_increment_s, b.scans[i].time_increment_s);
    EXPECT_EQ(a.scans[i].ring, b.scans[i].ring);
    EXPECT_EQ(a.scans[i].beams, b.scans[i].beams);
  }
  ASSERT_EQ(a.ranges_m.size(), b.ranges_m.size());
  EXPECT_EQ(std::memcmp(a.ranges_m.data(), b.ranges_m.data(), a.ranges_m.size() * sizeof(float)), 0);
  EXPECT_EQ(a.directions, b.directions);
  EXPECT_EQ(a.motor.time_s, b.motor.time_s);
  EXPECT_EQ(a.motor.angle_rad, b.motor.angle_rad);
}

TEST_F(CloudForms, EveryFormReadsAsTheSameRecording) {
  const CloudBench bench = short_bench();
  const Recording expected = bench.record();
  ASSERT_EQ(expected.scans.size(), 60U);
  const RawRecording whole = bench.raw(CloudDetail::kWhole);
  ASSERT_EQ(whole.lasers.at(0).clouds.size(), 15U);
  ReadOptions options;
  options.rig = bench.rig();
  const std::filesystem::path forms[] = {write(whole, "a.bag", RecordingFormat::kRos1, "lz4"),
                                         write(whole, "a.mcap", RecordingFormat::kMcap, "zstd")};
  for (const auto& form : forms) {
    const auto read = read_recording(form, options, Job());
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, expected);
    // And once more, from what was written.
    const auto again = read_raw_recording(form, bench.rig(), Job(), CloudDetail::kWhole);
    ASSERT_TRUE(again);
    const auto back = read_recording(write(*again, "b.mcap", RecordingFormat::kMcap), options, Job());
    ASSERT_TRUE(back);
    expect_same(*back, expected);
  }
}

TEST_F(CloudForms, ALivoxScannersCloudsAreWrittenAsPointClouds) {
  CloudBench bench = short_bench();
  bench.driver = CloudBench::Driver::kLivox2;
  const Recording expected = bench.record();
  const RawRecording whole = bench.raw(CloudDetail::kWhole);
  ReadOptions options;
  options.rig = bench.rig();
  for (const auto& form :
       {write(whole, "l.bag", RecordingFormat::kRos1), write(whole, "l.mcap", RecordingFormat::kMcap)}) {
    const auto read = read_recording(form, options, Job());
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, expected);
  }
}

TEST_F(CloudForms, TablesHaveNoPlaceForClouds) {
  const RawRecording whole = short_bench().raw(CloudDetail::kWhole);
  const auto written = write_recording(whole.lasers.at(0), whole.joints.at(0), RecordingFormat::kCsv, "none",
                                       folder_ / "csv", Job());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(written.error().message.find("as MCAP or ROS 1"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "csv"));
}

std::string cloud(const char* time_name, double per_s, bool rings, std::uint32_t seconds, double turn_s) {
  test::CloudBytes bytes(time_name, test::CloudType::kFloat32, rings);
  for (int beam = 0; beam < 100; ++beam) {
    const double azimuth = -3 + beam * 0.02;
    bytes.point(static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth)), 0,
                beam * turn_s / 100 * per_s, 0);
  }
  return bytes.message(MessageBytes::kCdr, seconds, 0);
}

TEST_F(CloudForms, WhatCannotBeReadEndsInASentence) {
  EXPECT_NE(refusal({cloud("when", 1, true, 1, 0.1)}).find("its points have no times"), std::string::npos);
  std::string cut = cloud("time", 1, true, 1, 0.1);
  cut.resize(cut.size() / 2);
  EXPECT_NE(refusal({cut, cut}).find("it is malformed"), std::string::npos);
  EXPECT_NE(refusal({cloud("time", 0, true, 1, 0.1)}).find("all have the same time"), std::string::npos);
}

TEST_F(CloudForms, TimesInNoKnownUnitAreRefused) {
  // Thousands of seconds and minutes, which are read as seconds.
  for (const double per_s : {1e-3, 1.0 / 60}) {
    std::vector<std::string> clouds;
    for (std::uint32_t i = 1; i < 8; ++i) clouds.push_back(cloud("time", per_s, true, i, 0.9));
    const std::string why = refusal(clouds);
    EXPECT_NE(why.find("the unit of the times is not known"), std::string::npos) << why;
  }
}

}  // namespace
}  // namespace sweepscope
