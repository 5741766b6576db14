#include "core/live/calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <functional>
#include <span>
#include <thread>
#include <utility>

#include "core/live/stream_source.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

/// A recording as the lines of a stream, in the order of time.
std::vector<std::string> lines_of(const Recording& recording) {
  std::vector<std::pair<double, std::string>> timed;
  for (const LaserScan& scan : recording.scans)
    timed.emplace_back(
        scan.first_beam_s,
        fmt::format("scan,{:.9f},{},{},{},{}\n", 1000 + scan.first_beam_s, scan.angle_min_rad,
                    scan.angle_increment_rad, scan.time_increment_s, fmt::join(recording.ranges(scan), " ")));
  for (std::size_t i = 0; i < recording.motor.time_s.size(); ++i)
    timed.emplace_back(
        recording.motor.time_s[i],
        fmt::format("motor,{:.9f},{}\n", 1000 + recording.motor.time_s[i], recording.motor.angle_rad[i]));
  std::ranges::stable_sort(timed, {}, [](const auto& line) { return line.first; });
  std::vector<std::string> lines = {
      "scan,stamp_s,angle_min_rad,angle_increment_rad,time_increment_s,ranges_m\n",
      "motor,stamp_s,angle_rad\n"};
  for (auto& [time_s, line] : timed) lines.push_back(std::move(line));
  return lines;
}

/// The two ends of a pipe; what is written into it comes from a thread of its own.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(pipe(ends_), 0); }
  ~Pipe() {
    close(ends_[0]);  // who still writes fails
    if (writer_.joinable()) writer_.join();
  }
  int reading_end() const { return ends_[0]; }
  /// `keep_open`: the input does not end behind the lines.
  void write_lines(std::vector<std::string> lines, bool keep_open = false) {
    writer_ = std::thread([this, lines = std::move(lines), keep_open] {
      for (const std::string& line : lines)
        if (write(ends_[1], line.data(), line.size()) < 0) break;
      if (!keep_open) close(ends_[1]);
    });
  }

 private:
  int ends_[2];
  std::thread writer_;
};

/// A source that hears what a test says, a piece at each listening, for ever.
class EndlessSource : public LiveSource {
 public:
  using Piece = std::function<void(int number, RawLaser& laser, RawJoint& joint)>;
  explicit EndlessSource(Piece piece) : piece_(std::move(piece)) {
    raw_.lasers.emplace_back();
    raw_.joints.emplace_back();
  }
  Result<bool> listen(std::chrono::milliseconds) override {
    piece_(number_++, raw_.lasers.front(), raw_.joints.front());
    return true;
  }
  const RawRecording& so_far() const override { return raw_; }
  RawRecording heard() override { return raw_; }
  RawRecording take() override { return std::exchange(raw_, {}); }

 private:
  Piece piece_;
  RawRecording raw_;
  int number_ = 0;
};

void add_scan(RawLaser& laser, double stamp_s, std::uint32_t beams = 3) {
  RawScan scan;
  scan.stamps.header_ns = std::llround(stamp_s * 1e9);
  scan.first_range = laser.ranges_m.size();
  scan.beams = beams;
  laser.ranges_m.resize(laser.ranges_m.size() + beams, 1.0f);
  laser.scans.push_back(scan);
}

void add_samples(RawJoint& joint, std::size_t count) {
  joint.stamps.resize(joint.stamps.size() + count, {1'000'000'000, 0});
  joint.positions.resize(joint.stamps.size());
}

class Calibration : public testing::Test {
 protected:
  void SetUp() override {
    signal(SIGPIPE, SIG_IGN);
    options_.estimate.method = Method::kDirect;
  }
  Result<ListeningEnd> listen_to(Pipe& pipe, const Job& job = Job()) {
    StreamSource source(pipe.reading_end(), "stream", options_.rig);
    const auto end = listen(source, options_, job, [&](const HeardSoFar&, const Result<Estimate>& answer) {
      ++told_;
      EXPECT_TRUE(answer);
    });
    heard_ = source.heard();
    return end;
  }
  /// How listening to such pieces ends.
  ListeningEnd end_of(EndlessSource::Piece piece) {
    EndlessSource source(std::move(piece));
    const auto end = listen(source, options_, Job(), [](const HeardSoFar&, const Result<Estimate>&) {});
    heard_ = source.heard();
    return end.value();
  }
  /// From now on the clock that silence is measured by advances by 1 ms with each listening.
  void count_listenings() {
    options_.now = [passed = std::chrono::steady_clock::time_point()]() mutable {
      return passed += std::chrono::milliseconds(1);
    };
  }
  CalibrationOptions options_;
  RawRecording heard_;
  int told_ = 0;
};

TEST_F(Calibration, FindsTheOffsetOfWhatItHeardUntilThen) {
  Pipe pipe;
  pipe.write_lines(lines_of(test::simulated("room-1", 0.0137, 9).recording));
  options_.seconds = 5;
  const auto end = listen_to(pipe);
  ASSERT_TRUE(end);
  EXPECT_EQ(*end, ListeningEnd::kHeardEnough);
  const HeardSoFar so_far = heard_so_far(heard_);
  EXPECT_GE(so_far.seconds, 5.0);
  EXPECT_LT(so_far.seconds, 8.0);  // and not all there is
  EXPECT_GT(so_far.motor_samples, 400U);
  const auto found = calibrate(heard_, options_, Job());
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->offset_s) << found->reasons().front();
  EXPECT_EQ(found->kind, RigKind::kStationary);
  EXPECT_NE(found->kind_reason.find("0 of"), std::string::npos) << found->kind_reason;
  EXPECT_NEAR(*found->offset_s * 1e3, 13.7, 0.1);
}

TEST_F(Calibration, EndsWithTheInputAndUsesWhatIsThere) {
  Pipe pipe;
  pipe.write_lines(lines_of(test::simulated("room-1", 0.0137, 4.5).recording));
  options_.seconds = 60;
  const auto end = listen_to(pipe);
  ASSERT_TRUE(end);
  EXPECT_EQ(*end, ListeningEnd::kInputEnded);
  const auto found = calibrate(heard_, options_, Job());
  ASSERT_TRUE(found && found->offset_s);
  EXPECT_NEAR(*found->offset_s * 1e3, 13.7, 0.1);
}

TEST_F(Calibration, TooLittleIsRefusedWithTheReason) {
  const std::vector<std::string> all = lines_of(test::simulated("room-1", 0.0137, 4.5).recording);
  const auto refusal = [&](std::vector<std::string> lines) {
    Pipe pipe;
    pipe.write_lines(std::move(lines));
    EXPECT_TRUE(listen_to(pipe));
    const auto found = calibrate(heard_, options_, Job());
    EXPECT_TRUE(found) << found.error().message;
    if (!found) return std::string();
    EXPECT_FALSE(found->identifiable);
    return found->reasons().empty() ? std::string() : found->reasons().front();
  };
  EXPECT_EQ(refusal({}), "No scans were received.");
  EXPECT_EQ(refusal({all[0], all[1], "scan,1000,-1,0.01,1e-4,1 2 3\n"}), "No motor angles were received.");
  EXPECT_FALSE(refusal({all.begin(), all.begin() + 60}).empty());
}

TEST_F(Calibration, ARigThatMovedIsRefused) {
  Pipe pipe;
  pipe.write_lines(lines_of(test::simulated("metro-station", 0.024, 10).recording));
  ASSERT_TRUE(listen_to(pipe));
  const auto found = calibrate(heard_, options_, Job());
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->identifiable);
  EXPECT_FALSE(found->offset_s);
  EXPECT_EQ(found->kind, RigKind::kMoving);
  EXPECT_EQ(found->reasons().back(), "The rig moved: a calibration requires a stationary rig.");
}

TEST_F(Calibration, SilenceAndCancellationEndIt) {
  std::vector<std::string> lines = lines_of(test::simulated("room-1", 0.0137, 4.5).recording);
  while (!lines.back().starts_with("scan")) lines.pop_back();
  Pipe silent;
  silent.write_lines(std::move(lines), true);
  count_listenings();
  options_.seconds = 60;
  options_.silence_s = 0.01;
  EXPECT_EQ(*listen_to(silent), ListeningEnd::kSilence);
  Pipe other;
  other.write_lines({}, true);
  Job job;
  job.cancel();
  EXPECT_EQ(*listen_to(other, job), ListeningEnd::kCancelled);
}

TEST_F(Calibration, AMotorAloneEndsItForWantOfScans) {
  count_listenings();
  options_.silence_s = 0.05;
  EXPECT_EQ(end_of([](int, RawLaser&, RawJoint& joint) { add_samples(joint, 1); }), ListeningEnd::kNoScans);
}

TEST_F(Calibration, SilenceAfterALastMotorSampleIsSilence) {
  count_listenings();
  options_.silence_s = 0.05;
  EXPECT_EQ(end_of([](int number, RawLaser& laser, RawJoint& joint) {
              if (number < 3) add_scan(laser, 1000 + 0.025 * number);
              if (number == 3) add_samples(joint, 1);
            }),
            ListeningEnd::kSilence);
}

TEST_F(Calibration, ScansWhoseStampsDoNotAdvanceEndIt) {
  count_listenings();
  options_.silence_s = 0.05;
  const auto same = [](int, RawLaser& laser, RawJoint& joint) {
    add_scan(laser, 1000);
    add_samples(joint, 1);
  };
  const auto backward = [](int number, RawLaser& laser, RawJoint&) {
    add_scan(laser, 1000 - 0.025 * number);
  };
  const auto there_and_back = [](int number, RawLaser& laser, RawJoint&) {
    add_scan(laser, 1000 + 0.025 * (number < 40 ? number : number % 40));
  };
  EXPECT_EQ(end_of(same), ListeningEnd::kStampsStandStill);
  EXPECT_EQ(end_of(backward), ListeningEnd::kStampsStandStill);
  EXPECT_EQ(end_of(there_and_back), ListeningEnd::kStampsStandStill);
  EXPECT_GE(heard_.lasers.front().scans.size(), 40U);
}

// Silence is far: what comes by then would fill any memory.
TEST_F(Calibration, WhatIsKeptIsBoundedWhateverComes) {
  options_.silence_s = 3600;
  options_.seconds = 0.5;
  const HeardLimits limits = limits_of(options_);
  EXPECT_EQ(end_of([](int, RawLaser&, RawJoint& joint) { add_samples(joint, 10'000); }),
            ListeningEnd::kTooMuch);
  EXPECT_LE(heard_.joints.front().stamps.size(), limits.motor_samples + 10'000);
  EXPECT_EQ(end_of([](int, RawLaser& laser, RawJoint&) { add_scan(laser, 1000, 10'000); }),
            ListeningEnd::kTooMuch);
  EXPECT_LE(heard_.lasers.front().ranges_m.size() * sizeof(float), limits.scan_bytes + 40'000);
}

TEST_F(Calibration, TheLimitsLeaveRoomForFastScannersAndMotors) {
  for (const double seconds : {0.5, 10.0, 600.0}) {
    options_.seconds = seconds;
    const HeardLimits limits = limits_of(options_);
    EXPECT_GT(double(limits.scan_bytes), 2 * seconds * 40 * 1081 * 2 * sizeof(float));
    EXPECT_GT(double(limits.motor_samples), 2 * seconds * 1000);
    EXPECT_LE(limits.scan_bytes, std::size_t{512'000'000});
    EXPECT_LE(limits.motor_samples, std::size_t{10'000'000});
  }
}

}  // namespace
}  // namespace sweepscope
