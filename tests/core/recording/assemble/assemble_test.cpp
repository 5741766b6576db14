#include "core/recording/assemble/assemble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kStart_ns = 1'500'000'000 * kSecond_ns;

std::int64_t at_ns(double since_s) {
  return kStart_ns + std::llround(since_s * 1e9);
}

void add_scan(RawLaser& laser, double since_s, const std::vector<float>& ranges_m = {1, 2, 3, 4, 5}) {
  RawScan scan;
  scan.stamps = {at_ns(since_s), at_ns(since_s) + 5'000'000};
  scan.angle_min_rad = -0.5F;
  scan.angle_increment_rad = 0.25F;
  scan.time_increment_s = 0.001F;
  scan.scan_time_s = 0.025F;
  scan.range_min_m = 0.5F;
  scan.range_max_m = 30;
  scan.first_range = laser.ranges_m.size();
  scan.beams = static_cast<std::uint32_t>(ranges_m.size());
  laser.ranges_m.insert(laser.ranges_m.end(), ranges_m.begin(), ranges_m.end());
  laser.intensities.resize(laser.ranges_m.size(), 7.0F);
  laser.scans.push_back(scan);
}

void add_sample(RawJoint& joint, double since_s, double position) {
  joint.stamps.push_back({at_ns(since_s), at_ns(since_s) + 5'000'000});
  joint.positions.push_back(position);
}

/// Scans every 25 ms from 0.25 s on, and a motor every 10 ms from 0 to 2 s that turns at 1 rad/s.
RawRecording sample() {
  RawRecording raw;
  raw.file = "folder/sample.bag";
  raw.name = "sample.bag";
  raw.topics = {{"/scan", "sensor_msgs/LaserScan", 40, 0}, {"/joints", "sensor_msgs/JointState", 200, 0}};
  raw.lasers.emplace_back().topic = "/scan";
  for (int i = 0; i < 40; ++i) add_scan(raw.lasers[0], 0.25 + 0.025 * i);
  RawJoint& joint = raw.joints.emplace_back();
  joint.topic = "/joints";
  joint.joint = "roll";
  for (int i = 0; i < 200; ++i) add_sample(joint, 0.01 * i, 0.01 * i);
  return raw;
}

Recording assembled(RawRecording raw, const Rig& rig = {}, std::optional<StampSource> stamps = {}) {
  auto recording = assemble(std::move(raw), rig, stamps);
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? *recording : Recording();
}

bool warns(const Recording& recording, const std::string& part) {
  for (const std::string& warning : recording.report.warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(Assemble, PutsBothStreamsOnOneEpochThatKeepsTimesPrecise) {
  const Recording recording = assembled(sample());
  EXPECT_EQ(recording.epoch_ns, kStart_ns);
  EXPECT_NEAR(recording.scans[0].first_beam_s, 0.25, 1e-12);
  EXPECT_NEAR(recording.motor.time_s[1], 0.01, 1e-12);
  EXPECT_EQ(recording.scans.size(), 40U);
  EXPECT_EQ(recording.ranges(recording.scans[3])[4], 5);
  EXPECT_EQ(recording.intensities.size(), recording.ranges_m.size());
  EXPECT_TRUE(recording.report.warnings.empty());
  EXPECT_EQ(recording.report.scan_gaps + recording.report.motor_gaps + recording.report.scans_without_motor,
            0U);
}

TEST(Assemble, CompletesTheRigWithWhatItDetected) {
  const Recording recording = assembled(sample());
  EXPECT_EQ(recording.rig.laser.topic, "/scan");
  EXPECT_EQ(recording.rig.motor.topic, "/joints");
  EXPECT_EQ(recording.rig.motor.joint, "roll");
  EXPECT_EQ(recording.rig.laser.stamp, StampSource::kHeader);
}

TEST(Assemble, AStampAtTheLastBeamOrOnArrivalIsTakenBackToTheFirst) {
  Rig rig;
  rig.laser.stamp_at = StampAt::kLastBeam;
  const Recording last = assembled(sample(), rig);
  EXPECT_NEAR(last.scans[0].first_beam_s, 0.25 - 4 * 0.001, 1e-9);
  EXPECT_NEAR(last.scans[0].last_beam_s(), 0.25, 1e-9);
  rig.laser.stamp_at = StampAt::kArrival;
  EXPECT_EQ(assembled(sample(), rig).scans[0].first_beam_s, last.scans[0].first_beam_s);
}

TEST(Assemble, TheMotorsAngleIsScaledAndThenZeroed) {
  Rig rig;
  rig.motor.scale = -2;
  rig.motor.zero_deg = 90;
  const Recording recording = assembled(sample(), rig);
  EXPECT_NEAR(recording.motor.angle_rad[50], -2 * 0.5 - std::numbers::pi / 2, 1e-12);
}

TEST(Assemble, StampsAreTheOptionsElseTheRigsElseHeaders) {
  Rig rig;
  rig.laser.stamp = rig.motor.stamp = StampSource::kReceive;
  EXPECT_NEAR(assembled(sample(), rig).scans[0].first_beam_s, 0.255, 1e-9);
  EXPECT_NEAR(assembled(sample(), rig, StampSource::kHeader).scans[0].first_beam_s, 0.25, 1e-9);
  const Recording received = assembled(sample(), {}, StampSource::kReceive);
  EXPECT_NEAR(received.scans[0].first_beam_s, 0.255, 1e-9);
  EXPECT_NEAR(received.motor.time_s[0], 0.005, 1e-9);
}

TEST(Assemble, MixingHeaderAndReceiveStampsWarns) {
  Rig rig;
  rig.motor.stamp = StampSource::kReceive;
  EXPECT_TRUE(warns(assembled(sample(), rig), "the laser uses header stamps and the motor receive times"));
}

TEST(Assemble, MessagesWithoutHeaderStampsGoByReceiveTimesWithAWarning) {
  RawRecording raw = sample();
  for (MessageStamps& stamps : raw.joints[0].stamps) stamps.header_ns = 0;
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.motor_stamps.used, StampSource::kReceive);
  EXPECT_NEAR(recording.motor.time_s[0], 0.005, 1e-9);
  EXPECT_TRUE(warns(recording, "no message on /joints has a header stamp"));
  EXPECT_TRUE(warns(recording, "the laser uses header stamps"));
}

TEST(Assemble, AScanWithoutAStampAmongOthersIsDropped) {
  RawRecording raw = sample();
  raw.lasers[0].scans[5].stamps.header_ns = 0;
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.scans.size(), 39U);
  EXPECT_EQ(recording.report.scans_dropped, 1U);
  EXPECT_TRUE(warns(recording, "1 of 40 scans on /scan were dropped: 1 have no stamp"));
}

TEST(Assemble, MeasuresTheReceiveDelayAndItsJitter) {
  RawRecording raw = sample();
  for (std::size_t i = 0; i < raw.joints[0].stamps.size(); ++i) {
    raw.joints[0].stamps[i].receive_ns += i % 3 == 0 ? 0 : i % 3 == 1 ? 1'000'000 : -1'000'000;
  }
  const ReadReport report = assembled(raw).report;
  EXPECT_NEAR(*report.laser_stamps.receive_minus_header_s, 0.005, 1e-9);
  EXPECT_NEAR(*report.laser_stamps.receive_jitter_s, 0, 1e-9);
  EXPECT_NEAR(*report.motor_stamps.receive_minus_header_s, 0.005, 1e-9);
  EXPECT_NEAR(*report.motor_stamps.receive_jitter_s, 0.0014826, 1e-9);
}

// A stalled link keeps messages back and delivers them at once.
TEST(Assemble, ReceiveTimesOfMessagesThatCameLateAreCorrected) {
  RawRecording raw = sample();
  raw.lasers[0].scans[7].stamps.receive_ns += 204'000'000;
  raw.lasers[0].scans[8].stamps.receive_ns += 104'000'000;
  raw.lasers[0].scans[20].stamps.receive_ns += 6'000'000;  // as late as messages are now and then
  raw.joints[0].stamps[30].receive_ns += 50'000'000;
  const Recording usual = assembled(sample(), {}, StampSource::kReceive),
                  received = assembled(raw, {}, StampSource::kReceive);
  ASSERT_EQ(received.scans.size(), usual.scans.size());
  for (std::size_t i = 0; i < usual.scans.size(); ++i)
    EXPECT_NEAR(received.scans[i].first_beam_s, usual.scans[i].first_beam_s + (i == 20 ? 0.006 : 0), 1e-8);
  for (std::size_t i = 0; i < usual.motor.time_s.size(); ++i)
    EXPECT_NEAR(received.motor.time_s[i], usual.motor.time_s[i], 1e-8);
  EXPECT_TRUE(warns(received, "2 of 40 messages on /scan were received up to 204 ms late"));
  EXPECT_TRUE(warns(received, "messages on /joints were received up to 50 ms late"));
  EXPECT_FALSE(warns(assembled(raw), "late"));
}

TEST(Assemble, NoMessageIsLateByHeaderStampsInAnotherUnit) {
  RawRecording raw = sample();
  for (MessageStamps& stamps : raw.joints[0].stamps)
    stamps.header_ns = kStart_ns + (stamps.header_ns - kStart_ns) / 1000;
  const Recording received = assembled(raw, {}, StampSource::kReceive);
  EXPECT_FALSE(warns(received, "late"));
  EXPECT_NEAR(received.motor.time_s[3] - received.motor.time_s[0],
              assembled(sample(), {}, StampSource::kReceive).motor.time_s[3] - received.motor.time_s[0],
              1e-8);
}

TEST(Assemble, HeaderStampsInAnotherUnitWarn) {
  RawRecording raw = sample();
  for (MessageStamps& stamps : raw.joints[0].stamps)
    stamps.header_ns = kStart_ns + (stamps.header_ns - kStart_ns) / 1000;
  EXPECT_TRUE(warns(assembled(raw),
                    "the header stamps of /joints run 0.001 times as fast as its receive times, as if they "
                    "were in another unit"));
}

TEST(Assemble, ClocksThatDoNotOverlapWarn) {
  RawRecording raw = sample();
  for (MessageStamps& stamps : raw.joints[0].stamps) stamps.header_ns -= 1000 * kSecond_ns;
  const Recording recording = assembled(raw);
  EXPECT_TRUE(warns(recording, "the two streams' clocks do not overlap"));
  EXPECT_EQ(recording.report.scans_without_motor, 40U);
}

TEST(Assemble, ScansOutOfOrderAreSortedWithTheirRangesAndCounted) {
  RawRecording raw;
  raw = sample();
  raw.lasers[0] = {};
  raw.lasers[0].topic = "/scan";
  add_scan(raw.lasers[0], 0.25, {1, 1});
  add_scan(raw.lasers[0], 0.30, {3, 3, 3});
  add_scan(raw.lasers[0], 0.275, {2});
  const Recording recording = assembled(raw);
  ASSERT_EQ(recording.scans.size(), 3U);
  EXPECT_EQ(recording.report.scans_out_of_order, 1U);
  EXPECT_EQ(recording.ranges_m, (std::vector<float>{1, 1, 2, 3, 3, 3}));
  EXPECT_EQ(recording.ranges(recording.scans[1]).size(), 1U);
  EXPECT_EQ(recording.scans[2].first_range, 3U);
}

TEST(Assemble, OfDoubledStampsTheFirstIsKept) {
  RawRecording raw = sample();
  add_scan(raw.lasers[0], 0.25, {9, 9, 9, 9, 9});
  add_sample(raw.joints[0], 0.5, 99);
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.scans.size(), 40U);
  EXPECT_EQ(recording.report.scans_duplicate, 1U);
  EXPECT_EQ(recording.ranges(recording.scans[0])[0], 1);
  EXPECT_EQ(recording.report.motor_duplicate, 1U);
  EXPECT_NEAR(recording.motor.angle_at(0.5), 0.5, 1e-9);
  EXPECT_EQ(recording.ranges_m.size(), 200U);
}

TEST(Assemble, RangesThatAreNoneBecomeNaNAndAreCountedByKind) {
  RawRecording raw = sample();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  add_scan(raw.lasers[0], 1.3, {NAN, kInfinity, -kInfinity, 0, 0.4F, 31, -2, 7});
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.nan_ranges, 1U);
  EXPECT_EQ(recording.report.infinite_ranges, 2U);
  EXPECT_EQ(recording.report.zero_ranges, 1U);
  EXPECT_EQ(recording.report.out_of_range_ranges, 3U);
  const auto ranges_m = recording.ranges(recording.scans.back());
  for (std::size_t i = 0; i < 7; ++i) EXPECT_TRUE(std::isnan(ranges_m[i])) << i;
  EXPECT_EQ(ranges_m[7], 7);
}

TEST(Assemble, ARangeLimitThatWasNeverSetLimitsNothing) {
  RawRecording raw = sample();
  for (RawScan& scan : raw.lasers[0].scans) scan.range_min_m = scan.range_max_m = 0;
  EXPECT_EQ(assembled(raw).report.out_of_range_ranges, 0U);
}

TEST(Assemble, IntensitiesAreKeptOnlyWhereEveryScanHasThem) {
  RawRecording raw = sample();
  raw.lasers[0].has_intensities = false;
  raw.lasers[0].intensities.clear();
  EXPECT_TRUE(assembled(raw).intensities.empty());
}

TEST(Assemble, GapsAreCountedAndTheLongestMeasured) {
  RawRecording raw = sample();
  add_scan(raw.lasers[0], 1.4);
  add_sample(raw.joints[0], 2.5, 2.5);
  const ReadReport report = assembled(raw).report;
  EXPECT_EQ(report.scan_gaps, 1U);
  EXPECT_NEAR(report.longest_scan_gap_s, 0.175, 1e-9);
  EXPECT_EQ(report.motor_gaps, 1U);
  EXPECT_NEAR(report.longest_motor_gap_s, 0.51, 1e-9);
  EXPECT_NEAR(report.laser_stamps.median_period_s, 0.025, 1e-9);
  EXPECT_NEAR(report.motor_stamps.median_period_s, 0.01, 1e-9);
}

TEST(Assemble, ScansInAGapOfTheMotorAreCountedAndWarnedOf) {
  RawRecording raw = sample();
  RawJoint& joint = raw.joints[0];
  joint.stamps.erase(joint.stamps.begin() + 40, joint.stamps.begin() + 60);  // from 0.40 to 0.59 s
  joint.positions.erase(joint.positions.begin() + 40, joint.positions.begin() + 60);
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.scans_without_motor, 8U);  // at 0.400 s (from 0.39 on) up to 0.575 s
  EXPECT_TRUE(warns(recording, "8 of 40 scans have no motor samples around them"));
}

TEST(Assemble, AMissingTimeIncrementIsTheRigsElseFromTheScanTime) {
  RawRecording raw = sample();
  for (RawScan& scan : raw.lasers[0].scans) scan.time_increment_s = 0;
  const Recording guessed = assembled(raw);
  EXPECT_NEAR(guessed.scans[0].time_increment_s, 0.005, 1e-9);
  EXPECT_TRUE(warns(guessed, "40 scans on /scan have no time_increment; scan_time / beams is used"));
  Rig rig;
  rig.laser.time_increment_s = 0.002;
  const Recording given = assembled(raw, rig);
  EXPECT_EQ(given.scans[0].time_increment_s, 0.002);
  EXPECT_TRUE(given.report.warnings.empty());
}

TEST(Assemble, ScansThatNeverSayHowLongTheyTakeAreInDoubt) {
  RawRecording raw = sample();
  for (RawScan& scan : raw.lasers[0].scans) scan.time_increment_s = scan.scan_time_s = 0;
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.scans[0].time_increment_s, 0);
  EXPECT_GT(recording.report.beam_time_doubt_s, 0);
  EXPECT_TRUE(warns(recording, "40 scans on /scan have neither a time_increment nor a scan_time"));
  // Without a period nothing is known of them.
  raw.lasers[0].scans.resize(4);
  const auto few = assemble(raw, {}, {});
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, ExitCode::kUnreadableInput);
  EXPECT_NE(few.error().message.find("4 have neither a time_increment nor a scan_time"), std::string::npos)
      << few.error().message;
}

TEST(Assemble, ATimeIncrementLongerThanTheScansSpacingWarns) {
  RawRecording raw = sample();
  for (RawScan& scan : raw.lasers[0].scans) scan.time_increment_s = 0.01F;
  EXPECT_TRUE(warns(assembled(raw), "its time_increment is too long"));
}

TEST(Assemble, AScanOfMoreBeamsThanCanBeToldApartIsRefused) {
  for (const std::uint32_t beams : {kMaxBeamsAScan, kMaxBeamsAScan + 1, 1'000'000U}) {
    RawRecording raw = sample();
    raw.lasers[0].scans.clear();
    raw.lasers[0].ranges_m.clear();
    for (int i = 0; i < 2; ++i)
      add_scan(raw.lasers[0], 0.25 + 0.025 * i, std::vector<float>(i == 0 ? 5 : beams, 2.0F));
    const auto recording = assemble(std::move(raw), {}, {});
    EXPECT_EQ(recording.has_value(), beams == kMaxBeamsAScan);
    if (recording) continue;
    EXPECT_EQ(recording.error().code, ExitCode::kUnreadableInput);
    EXPECT_EQ(recording.error().message, "folder/sample.bag: scan 2 on /scan has " + std::to_string(beams) +
                                             " beams; at most 65536 are supported");
  }
}

TEST(Assemble, BeamsMayRunTheOtherWay) {
  RawRecording raw = sample();
  for (RawScan& scan : raw.lasers[0].scans) {
    scan.angle_min_rad = 0.5F;
    scan.angle_increment_rad = -0.25F;
  }
  EXPECT_NEAR(assembled(raw).scans[0].beam_angle_rad(4), -0.5, 1e-9);
}

TEST(Assemble, BeamsFiredFromTheLastToTheFirstArePutInTheOrderOfTime) {
  for (const StampAt stamp_at : {StampAt::kFirstBeam, StampAt::kLastBeam}) {
    RawRecording raw = sample();
    for (RawScan& scan : raw.lasers[0].scans) scan.time_increment_s = -0.001F;
    raw.lasers[0].intensities[0] = 9;
    Rig rig;
    rig.laser.stamp_at = stamp_at;
    const Recording recording = assembled(raw, rig);
    const LaserScan& scan = recording.scans[0];
    // The stamp is that of the message's first beam, which was fired last.
    EXPECT_NEAR(scan.first_beam_s, 0.246, 1e-7);
    EXPECT_NEAR(scan.last_beam_s(), 0.25, 1e-7);
    EXPECT_NEAR(scan.beam_angle_rad(0), 0.5, 1e-6);
    EXPECT_NEAR(scan.beam_angle_rad(4), -0.5, 1e-6);
    EXPECT_EQ(recording.ranges(scan)[0], 5);
    EXPECT_EQ(recording.ranges(scan)[4], 1);
    EXPECT_EQ(recording.intensities[4], 9);
    EXPECT_FALSE(warns(recording, "time_increment"));
  }
}

TEST(Assemble, ARigFileMaySayThatTheLastBeamWasFiredFirst) {
  for (const StampAt stamp_at : {StampAt::kFirstBeam, StampAt::kLastBeam}) {
    Rig rig;
    rig.laser.stamp_at = stamp_at;
    rig.laser.time_increment_s = -0.001;
    const Recording recording = assembled(sample(), rig);
    const LaserScan& scan = recording.scans[0];
    // The stamp is that of the first beam fired, or of the last.
    EXPECT_NEAR(scan.first_beam_s, stamp_at == StampAt::kFirstBeam ? 0.25 : 0.246, 1e-7);
    EXPECT_NEAR(scan.beam_angle_rad(0), 0.5, 1e-6);
    EXPECT_EQ(recording.ranges(scan)[0], 5);
    EXPECT_EQ(recording.ranges(scan)[4], 1);
    EXPECT_TRUE(recording.report.fired_backwards);
  }
}

TEST(Assemble, ARigFileMaySayThatAllBeamsWereFiredAtOnce) {
  Rig rig;
  rig.laser.time_increment_s = 0;
  const Recording recording = assembled(sample(), rig);
  EXPECT_EQ(recording.scans[0].first_beam_s, recording.scans[0].last_beam_s());
  EXPECT_EQ(recording.report.beam_time_doubt_s, 0);
}

TEST(Assemble, ScansWithoutBeamsOrDirectionsAreDropped) {
  RawRecording raw = sample();
  raw.lasers[0].scans[1].angle_min_rad = NAN;
  raw.lasers[0].scans[2].angle_increment_rad = 0;
  add_scan(raw.lasers[0], 1.3, {});
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.scans_dropped, 3U);
  EXPECT_EQ(recording.scans.size(), 38U);
}

TEST(Assemble, AWrappedAngleIsUnwrapped) {
  RawRecording raw = sample();
  for (double& position : raw.joints[0].positions)
    position = std::remainder(5 * position, 2 * std::numbers::pi);
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.motor_unwrapped, 2U);
  EXPECT_NEAR(recording.motor.angle_rad.back(), 5 * 1.99, 1e-9);
}

TEST(Assemble, AngleJumpsAcrossAGapStayAsTheyAre) {
  RawRecording raw = sample();
  add_sample(raw.joints[0], 2.5, 1.99 - 6);
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.motor_unwrapped, 0U);
  EXPECT_NEAR(recording.motor.angle_rad.back(), 1.99 - 6, 1e-9);
}

TEST(Assemble, MotorSamplesThatAreNoNumberAreDropped) {
  RawRecording raw = sample();
  raw.joints[0].positions[3] = NAN;
  raw.joints[0].stamps[4].header_ns = 0;
  const Recording recording = assembled(raw);
  EXPECT_EQ(recording.report.motor_dropped, 2U);
  EXPECT_EQ(recording.motor.time_s.size(), 198U);
  EXPECT_TRUE(warns(recording, "2 of 200 samples of joint roll were dropped"));
}

TEST(Assemble, AMotorWithOneSampleIsRefused) {
  RawRecording raw = sample();
  raw.joints[0].stamps.resize(1);
  raw.joints[0].positions.resize(1);
  const auto recording = assemble(raw, {}, {});
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().message,
            "folder/sample.bag: joint roll on /joints has 1 usable samples; at least two are needed");
}

TEST(Assemble, SeveralFrameIdsOnTheLasersTopicAreNamed) {
  const auto names_frames = [](const RawRecording& raw) {
    return std::ranges::any_of(assembled(raw).report.warnings, [](const std::string& warning) {
      return warning.find("2 frame_ids, front and rear") != std::string::npos;
    });
  };
  RawRecording raw = sample();
  raw.lasers[0].frame = "front";
  EXPECT_FALSE(names_frames(raw));
  raw.lasers[0].other_frames = {"rear"};
  EXPECT_TRUE(names_frames(raw));
}

}  // namespace
}  // namespace sweepscope
