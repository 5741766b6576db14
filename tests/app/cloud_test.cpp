// Recordings of clouds, through the shipped executable.
#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/recording/formats/recording_writer.hpp"
#include "tests/core/cloud_bench.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

class CloudRecordings : public test::ProgramTest {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "rig.yaml")
        << "mount: {axis: [0, 1, 0], laser_in_motor: {xyz_m: [0.05, 0, 0.08]}}\n";
  }
  void write(const RawRecording& raw, const char* name, RecordingFormat format) const {
    const auto written =
        write_recording(raw.lasers.at(0), raw.joints.at(0), format, "none", folder_ / name, Job());
    ASSERT_TRUE(written) << written.error().message;
  }
};

TEST_F(CloudRecordings, AreShownEstimatedMappedAndConverted) {
  const test::CloudBench bench;
  write(bench.raw(CloudDetail::kWhole), "clouds.bag", RecordingFormat::kRos1);
  const Outcome info = run("info clouds.bag --rig rig.yaml");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("sensor_msgs/PointCloud2"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("2960 of clouds, on 16 rings, of 4"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("stationary"), std::string::npos) << info.out;

  const Outcome converted = run("convert clouds.bag --rig rig.yaml -o clouds.mcap --compression zstd");
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  EXPECT_EQ(converted.out.rfind("clouds.mcap: 185 clouds of /points and ", 0), 0U) << converted.out;
  nlohmann::json offsets_ms[2];
  for (const int i : {0, 1}) {
    const Outcome outcome = run(std::string("estimate clouds") + (i == 0 ? ".bag" : ".mcap") +
                                " --rig rig.yaml --json - --no-timing");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    offsets_ms[i] = nlohmann::json::parse(outcome.out, nullptr, false)["offset_ms"];
  }
  ASSERT_TRUE(offsets_ms[0].is_number());
  EXPECT_EQ(offsets_ms[0], offsets_ms[1]);
  EXPECT_NEAR(offsets_ms[0].get<double>(), bench.offset_s * 1e3, 0.5);

  const Outcome mapped = run("map clouds.mcap --rig rig.yaml --offset-ms 24.3 --voxel-m 0.1 -o map.pcd");
  EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
  EXPECT_TRUE(exists("map.pcd"));
  const Outcome tables = run("convert clouds.bag --rig rig.yaml -o tables");
  EXPECT_EQ(tables.exit_code, 2);
  EXPECT_NE(tables.err.find("cannot hold clouds"), std::string::npos) << tables.err;
  EXPECT_FALSE(exists("tables"));
}

TEST_F(CloudRecordings, ThatAreDamagedEndInOneSentence) {
  test::CloudBench bench;
  bench.rings = 2;
  bench.beams = 100;
  bench.duration_s = 2;
  RawRecording raw = bench.raw(CloudDetail::kWhole);
  std::vector<RawCloud>& clouds = raw.lasers.at(0).clouds;
  const std::vector<RawCloud> whole = clouds;
  const auto refused = [&](const char* why, const std::function<void(RawCloud&)>& damage) {
    clouds = whole;
    for (RawCloud& cloud : clouds) damage(cloud);
    write(raw, "damaged.bag", RecordingFormat::kRos1);
    const Outcome outcome = run("estimate damaged.bag --json out.json");
    EXPECT_EQ(outcome.exit_code, 3) << why << outcome.err;
    EXPECT_NE(outcome.err.find("damaged.bag: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_FALSE(exists("out.json"));
  };
  refused("it is malformed", [](RawCloud& cloud) { cloud.fields[0].offset = 1'000'000; });
  refused("it is malformed", [](RawCloud& cloud) { cloud.row_bytes = 7, cloud.height = 2; });
  refused("it is malformed", [](RawCloud& cloud) { cloud.width = cloud.height = 0xFFFFFFFF; });
  refused("its points have no times", [](RawCloud& cloud) { cloud.fields.pop_back(); });
  refused("no x, y, z", [](RawCloud& cloud) { cloud.fields[2].name = "w"; });
  refused("has a line of points", [](RawCloud& cloud) {
    for (std::size_t at = 0; at + 4 <= cloud.data.size(); at += cloud.point_bytes)
      std::fill_n(cloud.data.begin() + std::ptrdiff_t(at), 4, std::byte{0xFF});  // x: not a number
  });
}

}  // namespace
}  // namespace sweepscope
