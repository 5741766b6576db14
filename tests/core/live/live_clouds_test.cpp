// Clouds of a running rig are those of its recording: the messages come one by one, in many orders.
#include "core/live/live_clouds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "core/apply/added_topics.hpp"
#include "core/map/sweep_clouds.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/recording/take_messages.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope {
namespace {

constexpr double kOffset_s = 0.0173;

SimulationOptions options_of(simulation::MotorKind motor = simulation::MotorKind::kTriangle,
                             double duration_s = 6) {
  SimulationOptions options;
  options.scene = "room-1";
  options.offset_s = kOffset_s;
  options.duration_s = duration_s;
  options.motor = motor;
  return options;
}

RawRecording simulated_messages(const SimulationOptions& options) {
  const auto simulation = simulate(options, Job());
  EXPECT_TRUE(simulation) << simulation.error().message;
  return messages_of(*simulation);
}

/// A recording with one of its messages.
RawRecording message_of(const RawRecording& raw, const WrittenMessage& message) {
  RawRecording one;
  one.file = one.name = "test";
  one.topics = raw.topics;
  const RawLaser& laser = raw.lasers.at(0);
  const RawJoint& joint = raw.joints.at(0);
  RawLaser& scans = one.lasers.emplace_back(without_scans(laser));
  RawJoint& samples = one.joints.emplace_back(without_samples(joint));
  if (!message.is_scan) {
    samples.stamps.push_back(joint.stamps[message.number]);
    samples.positions.push_back(joint.positions[message.number]);
    return one;
  }
  const RawScan& scan = laser.scans[message.number];
  const auto part = [&](const std::vector<float>& all) {
    const auto first = all.begin() + std::ptrdiff_t(scan.first_range);
    return all.empty() ? std::vector<float>() : std::vector<float>(first, first + scan.beams);
  };
  scans.scans.push_back(scan);
  scans.scans.back().first_range = 0;
  scans.ranges_m = part(laser.ranges_m);
  scans.intensities = part(laser.intensities);
  return one;
}

std::vector<WrittenMessage> in_order(const RawRecording& raw) {
  return write_order(raw.lasers.at(0), raw.joints.at(0));
}

struct LivePlaced {
  std::vector<LiveCloud> clouds;
  std::vector<LivePose> poses;
  std::vector<std::string> warnings;
  std::vector<double> late_s;  // of each cloud's last beam, by the stamp of the message before it came
  void add(LiveNews news, std::int64_t now_ns) {
    for (LiveCloud& cloud : news.clouds) {
      late_s.push_back(double(now_ns - cloud.stamp_ns()) * 1e-9 - (cloud.end_s - cloud.begin_s));
      clouds.push_back(std::move(cloud));
    }
    poses.insert(poses.end(), news.poses.begin(), news.poses.end());
    warnings.insert(warnings.end(), news.warnings.begin(), news.warnings.end());
  }
};

LivePlaced placed(const RawRecording& raw, const std::vector<WrittenMessage>& order,
                  LiveCloudOptions options = {}, std::optional<double> offset_s = kOffset_s) {
  LiveClouds clouds(std::move(options));
  if (offset_s) clouds.set_offset(*offset_s);
  LivePlaced placed;
  for (const WrittenMessage& message : order) {
    auto news = clouds.take(message_of(raw, message));
    EXPECT_TRUE(news) << news.error().message;
    if (news) placed.add(std::move(*news), message.receive_ns);
  }
  auto rest = clouds.finish();
  EXPECT_TRUE(rest) << rest.error().message;
  if (rest) placed.add(std::move(*rest), order.back().receive_ns);
  return placed;
}

using Points = std::map<std::int64_t, Eigen::Vector3f>;  // by the beam's time in tenths of a microsecond

void add_points(const MapCloud& cloud, std::int64_t epoch_ns, Points& points) {
  for (const MapPoint& point : cloud.points)
    points[(epoch_ns + std::llround(point.time_s * 1e9) + 50) / 100] = point.getVector3fMap();
}

/// What `apply --clouds` makes of the whole recording.
struct Applied {
  Points points;
  std::map<std::int64_t, std::size_t> clouds;  // the points of each, by its stamp
};
Applied applied(const RawRecording& raw) {
  const auto recording = assemble(raw, Rig(), {});
  EXPECT_TRUE(recording) << recording.error().message;
  const Recording moved = without_offset(*recording, ClockShift(kOffset_s));
  MapOptions options;
  options.assume = RigKind::kStationary;
  const auto prepared = prepare(moved, options.features, Job());
  EXPECT_TRUE(prepared);
  const auto clouds = SweepClouds::create(*prepared, 0, options, Job());
  EXPECT_TRUE(clouds) << clouds.error().message;
  Applied applied;
  for (std::size_t i = 0; i < clouds->size(); ++i) {
    const SweepCloud cloud = clouds->at(i);
    add_points(cloud.points, moved.epoch_ns, applied.points);
    applied.clouds[moved.epoch_ns + std::llround(cloud.begin_s * 1e9)] = cloud.points.size();
  }
  return applied;
}

void expect_same_points(const LivePlaced& live, const Applied& expected) {
  Points points;
  std::size_t count = 0;
  for (const LiveCloud& cloud : live.clouds) {
    add_points(cloud.points, cloud.epoch_ns, points);
    count += cloud.points.size();
  }
  EXPECT_EQ(points.size(), count) << "a beam was placed twice";
  ASSERT_EQ(points.size(), expected.points.size());
  float worst_m = 0;
  auto other = expected.points.begin();
  for (auto one = points.begin(); one != points.end(); ++one, ++other) {
    ASSERT_LE(std::abs(one->first - other->first), 1);
    worst_m = std::max(worst_m, (one->second - other->second).norm());
  }
  EXPECT_LT(worst_m, 1e-5F);
}

/// All but the first and the last, which `apply` may join to others.
void expect_same_clouds(const LivePlaced& live, const Applied& expected) {
  expect_same_points(live, expected);
  std::map<std::int64_t, std::size_t> clouds;
  for (const LiveCloud& cloud : live.clouds) clouds[cloud.stamp_ns()] = cloud.points.size();
  ASSERT_GE(expected.clouds.size(), 4U);
  for (auto one = std::next(expected.clouds.begin()); one != std::prev(expected.clouds.end()); ++one)
    EXPECT_EQ(clouds[one->first], one->second) << "the cloud of " << one->first;
}

/// Every message comes up to so much later than it did; `seed` decides which ones.
std::vector<WrittenMessage> delayed(std::vector<WrittenMessage> order, double max_s, unsigned seed) {
  std::mt19937 random(seed);
  for (WrittenMessage& message : order)
    message.receive_ns += std::llround(max_s * 1e9 * (double(random()) / 4294967296.0));
  std::ranges::stable_sort(order, {}, &WrittenMessage::receive_ns);
  return order;
}

class LiveCloudsOfMotor : public testing::TestWithParam<simulation::MotorKind> {};

TEST_P(LiveCloudsOfMotor, AreThoseOfTheRecording) {
  const RawRecording raw = simulated_messages(options_of(GetParam()));
  expect_same_clouds(placed(raw, in_order(raw)), applied(raw));
}

TEST_P(LiveCloudsOfMotor, AreTheSameWhereMessagesAreLateAndReordered) {
  const RawRecording raw = simulated_messages(options_of(GetParam()));
  const Applied expected = applied(raw);
  for (const unsigned seed : {1U, 2U, 3U})
    expect_same_clouds(placed(raw, delayed(in_order(raw), 0.15, seed)), expected);
}

INSTANTIATE_TEST_SUITE_P(Motors, LiveCloudsOfMotor,
                         testing::Values(simulation::MotorKind::kTriangle, simulation::MotorKind::kTrapezoid,
                                         simulation::MotorKind::kSine));

TEST(LiveClouds, OneStreamMayComeMuchLaterThanTheOther) {
  const RawRecording raw = simulated_messages(options_of());
  const Applied expected = applied(raw);
  for (const bool late_scans : {false, true}) {
    auto order = in_order(raw);
    for (WrittenMessage& message : order)
      if (message.is_scan == late_scans) message.receive_ns += 1'500'000'000;
    std::ranges::stable_sort(order, {}, &WrittenMessage::receive_ns);
    expect_same_clouds(placed(raw, order), expected);
  }
}

TEST(LiveClouds, OfEachScanHoldTheSamePoints) {
  const RawRecording raw = simulated_messages(options_of());
  LiveCloudOptions options;
  options.each_scan = true;
  const LivePlaced live = placed(raw, delayed(in_order(raw), 0.1, 4), options);
  expect_same_points(live, applied(raw));
  EXPECT_GE(live.clouds.size(), 230U);
  for (std::size_t i = 1; i < live.clouds.size(); ++i)
    EXPECT_LT(live.clouds[i - 1].stamp_ns(), live.clouds[i].stamp_ns());
}

TEST(LiveClouds, OfASweepComeWithin50MsOfItsEnd) {
  const RawRecording raw = simulated_messages(options_of());
  const LivePlaced live = placed(raw, in_order(raw));
  ASSERT_GE(live.clouds.size(), 10U);
  // Those of the first two seconds come together; the last one ends with the input.
  for (std::size_t i = 5; i + 1 < live.clouds.size(); ++i) EXPECT_LT(live.late_s[i], 0.05) << i;
}

TEST(LiveClouds, ComeWithThePosesOfTheLaser) {
  const RawRecording raw = simulated_messages(options_of());
  const LivePlaced live = placed(raw, delayed(in_order(raw), 0.1, 5));
  EXPECT_EQ(live.poses.size(), raw.joints.at(0).stamps.size());
  for (std::size_t i = 1; i < live.poses.size(); ++i)
    EXPECT_LT(live.poses[i - 1].stamp_ns, live.poses[i].stamp_ns);
}

TEST(LiveClouds, LostMessagesAreNotWaitedForLong) {
  const RawRecording raw = simulated_messages(options_of());
  auto order = in_order(raw);
  const std::int64_t first_ns = order.front().receive_ns;
  std::erase_if(order, [&](const WrittenMessage& message) {
    const double at_s = double(message.receive_ns - first_ns) * 1e-9;
    return (at_s > 3 && at_s < 3.4) || (message.is_scan && message.number == 90);
  });
  const LivePlaced live = placed(raw, order);
  RawRecording rest = raw;
  std::vector<RawScan> scans;
  RawJoint& joint = rest.joints.at(0);
  const RawJoint all = std::exchange(joint, without_samples(joint));
  for (const WrittenMessage& message : order) {
    if (message.is_scan) scans.push_back(raw.lasers.at(0).scans[message.number]);
    if (message.is_scan) continue;
    joint.stamps.push_back(all.stamps[message.number]);
    joint.positions.push_back(all.positions[message.number]);
  }
  rest.lasers.at(0).scans = scans;
  expect_same_points(live, applied(rest));
  for (const double late_s : live.late_s) EXPECT_LT(late_s, 2.0);
}

TEST(LiveClouds, RepeatedMessagesCountOnce) {
  const RawRecording raw = simulated_messages(options_of());
  auto order = in_order(raw);
  // A server that begins anew sends what it sent a moment ago.
  const std::vector<WrittenMessage> again(order.begin() + 300, order.begin() + 420);
  order.insert(order.begin() + 420, again.begin(), again.end());
  expect_same_clouds(placed(raw, order), applied(raw));
}

TEST(LiveClouds, OfAMotorThatTurnsOneWayAreHalfTurns) {
  const RawRecording raw = simulated_messages(options_of(simulation::MotorKind::kOneWay));
  expect_same_clouds(placed(raw, in_order(raw)), applied(raw));
}

TEST(LiveClouds, AMotorThatRestsEndsItsSweep) {
  SimulationOptions options = options_of(simulation::MotorKind::kTriangle, 10);
  options.motor_rest_at_s = 4;
  options.motor_rest_s = 3;
  const RawRecording raw = simulated_messages(options);
  const LivePlaced live = placed(raw, in_order(raw));
  expect_same_points(live, applied(raw));
  for (const double late_s : live.late_s) EXPECT_LT(late_s, 2.1);
}

TEST(LiveClouds, AClockThatIsSetBackBeginsThemAnew) {
  const RawRecording raw = simulated_messages(options_of());
  LiveClouds clouds{LiveCloudOptions()};
  clouds.set_offset(kOffset_s);
  std::size_t count = 0;
  std::vector<std::string> warnings;
  for (const std::int64_t shift_ns : {100 * kSecond_ns, std::int64_t{0}})
    for (const WrittenMessage& message : in_order(raw)) {
      RawRecording one = message_of(raw, message);
      for (RawScan& scan : one.lasers[0].scans) scan.stamps.header_ns += shift_ns;
      for (MessageStamps& stamps : one.joints[0].stamps) stamps.header_ns += shift_ns;
      const auto news = clouds.take(std::move(one));
      ASSERT_TRUE(news) << news.error().message;
      count += news->clouds.size();
      warnings.insert(warnings.end(), news->warnings.begin(), news->warnings.end());
    }
  EXPECT_GE(count, 20U);
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& warning) {
    return warning.find("The stamps jumped") != std::string::npos;
  }));
}

TEST(LiveClouds, KeepNoMoreThanTheyNeed) {
  const RawRecording raw = simulated_messages(options_of());
  const std::int64_t length_ns = 6 * kSecond_ns;
  LiveClouds clouds{LiveCloudOptions()};
  clouds.set_offset(kOffset_s);
  std::array<std::size_t, 2> most_scans{}, most_samples{};  // in the first rounds, and in the later ones
  const std::int64_t first_ns = raw.lasers.at(0).scans.front().stamps.header_ns;
  const auto is_within = [&](const WrittenMessage& message) {
    const std::int64_t ns = message.is_scan ? raw.lasers[0].scans[message.number].stamps.header_ns
                                            : raw.joints[0].stamps[message.number].header_ns;
    return ns >= first_ns && ns < first_ns + length_ns;
  };
  for (int round = 0; round < 10; ++round)
    for (const WrittenMessage& message : in_order(raw)) {
      if (!is_within(message)) continue;
      RawRecording one = message_of(raw, message);
      for (RawScan& scan : one.lasers[0].scans) scan.stamps.header_ns += round * length_ns;
      for (MessageStamps& stamps : one.joints[0].stamps) stamps.header_ns += round * length_ns;
      ASSERT_TRUE(clouds.take(std::move(one)));
      const std::size_t half = round < 5 ? 0 : 1;
      most_scans[half] = std::max(most_scans[half], clouds.kept().lasers[0].scans.size());
      most_samples[half] = std::max(most_samples[half], clouds.kept().joints[0].stamps.size());
    }
  // Each round is 6 s; where the next one begins, the motor's angle jumps.
  EXPECT_LE(most_scans[1], most_scans[0]);
  EXPECT_LE(most_samples[1], most_samples[0]);
  EXPECT_LT(most_scans[0], 400U);
  EXPECT_LT(most_samples[0], 1000U);
}

TEST(LiveClouds, WithoutAnOffsetNothingIsPlacedAndTheLastSecondsAreKept) {
  const RawRecording raw = simulated_messages(options_of());
  LiveCloudOptions options;
  options.keep_s = 4;
  LiveClouds clouds{options};
  for (const WrittenMessage& message : in_order(raw)) {
    const auto news = clouds.take(message_of(raw, message));
    ASSERT_TRUE(news);
    EXPECT_TRUE(news->clouds.empty());
  }
  EXPECT_GE(clouds.kept_s(), 4);
  clouds.set_offset(kOffset_s);
  const auto rest = clouds.finish();
  ASSERT_TRUE(rest);
  EXPECT_GE(rest->clouds.size(), 8U);
}

TEST(LiveClouds, TooLittleIsAnError) {
  const RawRecording raw = simulated_messages(options_of());
  LiveClouds nothing{LiveCloudOptions()};
  EXPECT_EQ(nothing.finish().error().message, ": No scans were received.");
  LiveClouds scans{LiveCloudOptions()};
  for (const WrittenMessage& message : in_order(raw))
    if (message.is_scan) {
      ASSERT_TRUE(scans.take(message_of(raw, message)));
    }
  const auto ended = scans.finish();
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ExitCode::kUnreadableInput);
  EXPECT_EQ(ended.error().message, "test: No motor angles were received.");
}

}  // namespace
}  // namespace sweepscope
