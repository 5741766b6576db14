#include "core/simulation/write_simulation.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/recording/formats/read_recording.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

using test::contents_of;

void expect_equal(const Recording& read, const Recording& made) {
  EXPECT_EQ(read.epoch_ns, made.epoch_ns);
  EXPECT_EQ(read.motor.time_s, made.motor.time_s);
  EXPECT_EQ(read.motor.angle_rad, made.motor.angle_rad);
  EXPECT_EQ(read.intensities, made.intensities);
  EXPECT_EQ(read.directions, made.directions);
  ASSERT_EQ(read.scans.size(), made.scans.size());
  for (std::size_t i = 0; i < made.scans.size(); ++i) {
    EXPECT_EQ(read.scans[i].first_beam_s, made.scans[i].first_beam_s);
    EXPECT_EQ(read.scans[i].time_increment_s, made.scans[i].time_increment_s);
    EXPECT_EQ(read.scans[i].angle_min_rad, made.scans[i].angle_min_rad);
    EXPECT_EQ(read.scans[i].angle_increment_rad, made.scans[i].angle_increment_rad);
    EXPECT_EQ(read.scans[i].beams, made.scans[i].beams);
    EXPECT_EQ(read.scans[i].ring, made.scans[i].ring);
  }
  ASSERT_EQ(read.ranges_m.size(), made.ranges_m.size());
  for (std::size_t i = 0; i < made.ranges_m.size(); ++i)
    ASSERT_TRUE(read.ranges_m[i] == made.ranges_m[i] ||
                (std::isnan(read.ranges_m[i]) && std::isnan(made.ranges_m[i])));
}

class WriteBag : public test::FolderTest {
 protected:
  WriteBag() {
    SimulationOptions options;
    options.duration_s = 1.2;
    simulation_ = simulate(options, job_).value();
  }

  Job job_;
  Simulation simulation_;
};

TEST_F(WriteBag, IsReadBackAsItWasInMemory) {
  ASSERT_TRUE(write_bag(simulation_, folder_ / "r.bag", job_));
  const auto read = read_recording(folder_ / "r.bag", {}, job_);
  ASSERT_TRUE(read) << read.error().message;
  expect_equal(*read, simulation_.recording);
  EXPECT_GT(read->report.infinite_ranges, 0U);
  EXPECT_EQ(read->report.nan_ranges, 0U);
  EXPECT_TRUE(read->report.warnings.empty());
}

TEST_F(WriteBag, OfA3dScannerIsReadBackAsItWasInMemory) {
  SimulationOptions options;
  options.scanner = *simulation::scanner("vlp16");
  options.duration_s = 0.5;
  const Simulation simulation = simulate(options, job_).value();
  ASSERT_TRUE(write_bag(simulation, folder_ / "r.bag", job_));
  const auto read = read_recording(folder_ / "r.bag", {}, job_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->scans.size(), 5U * 16U);
  expect_equal(*read, simulation.recording);
  EXPECT_TRUE(read->report.warnings.empty());
}

TEST_F(WriteBag, OnReceiveStampsTheOffsetIsTheTruthsReceiveOffset) {
  ASSERT_TRUE(write_bag(simulation_, folder_ / "r.bag", job_));
  const auto read = read_recording(folder_ / "r.bag", {.rig = {}, .stamps = StampSource::kReceive}, job_);
  ASSERT_TRUE(read) << read.error().message;
  const double late_s = (read->scans[9].first_beam_s + 1e-9 * static_cast<double>(read->epoch_ns)) -
                        (simulation_.recording.scans[9].first_beam_s +
                         1e-9 * static_cast<double>(simulation_.recording.epoch_ns));
  EXPECT_GT(late_s, 0.0125 + kScanLatency_s - 1e-6);
  EXPECT_LT(late_s, 0.0125 + kScanLatency_s + 0.004);
  const auto truth = nlohmann::json::parse(truth_json(simulation_));
  EXPECT_NEAR(truth["receive_offset_ms"], 24 + 1.5 - 12.5 - 4.0, 0.01);
}

TEST_F(WriteBag, EqualSimulationsGiveEqualBytes) {
  ASSERT_TRUE(write_bag(simulation_, folder_ / "a.bag", job_));
  ASSERT_TRUE(write_bag(simulate(simulation_.options, job_).value(), folder_ / "b.bag", job_));
  EXPECT_TRUE(contents_of(folder_ / "a.bag") == contents_of(folder_ / "b.bag"));
  EXPECT_GT(contents_of(folder_ / "a.bag").size(), 100'000U);
}

TEST_F(WriteBag, LeavesNothingBehindWhereItCannotWrite) {
  fs::create_directories(folder_ / "taken.bag" / "inside");
  const auto written = write_bag(simulation_, folder_ / "taken.bag", job_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(written.error().message.find("taken.bag"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "taken.bag.part"));
}

TEST_F(WriteBag, TheTruthNamesTheOffsetAndEveryOption) {
  ASSERT_TRUE(write_truth(simulation_, folder_ / "walk.bag"));
  const auto json = nlohmann::json::parse(contents_of(folder_ / "walk.truth.json"));
  EXPECT_EQ(json["equation"], "t_motor = t_laser + offset");
  EXPECT_EQ(json["offset_ms"], 24.0);
  EXPECT_EQ(json["scene"], "room-1");
  EXPECT_EQ(json["options"]["seed"], 1);
  EXPECT_EQ(json["options"]["encoder_step_deg"], 0.088);
}

TEST_F(WriteBag, TheTrajectoryIsTumOnTheLasersClock) {
  ASSERT_TRUE(write_truth(simulation_, folder_ / "walk.bag"));
  std::istringstream lines(contents_of(folder_ / "walk.truth.tum"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "# timestamp tx ty tz qx qy qz qw");
  std::getline(lines, line);
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 21), "1489900000.010000000 ");
  double numbers[8];
  std::istringstream words(line);
  for (double& number : numbers) ASSERT_TRUE(words >> number);
  EXPECT_NEAR(numbers[1], simulation_.truth[1].position_m.x(), 1e-6);
  EXPECT_NEAR(numbers[7], simulation_.truth[1].orientation.w(), 1e-8);
}

}  // namespace
}  // namespace sweepscope
