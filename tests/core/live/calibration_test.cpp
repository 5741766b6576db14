#include "core/live/calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <span>
#include <thread>

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
  ASSERT_TRUE(found->offset_s) << found->reasons.front();
  EXPECT_EQ(found->kind, "stationary");
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
    return found->reasons.empty() ? std::string() : found->reasons.front();
  };
  EXPECT_EQ(refusal({}), "No scans were heard.");
  EXPECT_EQ(refusal({all[0], all[1], "scan,1000,-1,0.01,1e-4,1 2 3\n"}), "No angles of a motor were heard.");
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
  EXPECT_EQ(found->kind, "moving");
  EXPECT_EQ(found->reasons.back(), "The rig moved: a calibration wants it to stand still.");
}

TEST_F(Calibration, SilenceAndCancellationEndIt) {
  Pipe silent;
  silent.write_lines(lines_of(test::simulated("room-1", 0.0137, 4.5).recording), true);
  options_.seconds = 60;
  options_.silence_s = 0.2;
  EXPECT_EQ(*listen_to(silent), ListeningEnd::kSilence);
  Pipe other;
  other.write_lines({}, true);
  Job job;
  job.cancel();
  EXPECT_EQ(*listen_to(other, job), ListeningEnd::kCancelled);
}

}  // namespace
}  // namespace sweepscope
