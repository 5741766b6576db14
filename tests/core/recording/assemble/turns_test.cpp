#include "core/recording/assemble/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sweepscope {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi, kTimeIncrement_s = 0.1 / 720;
constexpr std::uint32_t kBeams = 60;  // of a part; 720 of a turn

RawScan message(double angle_min_rad, std::uint32_t beams) {
  RawScan scan;
  scan.angle_min_rad = static_cast<float>(std::remainder(angle_min_rad, kTurn_rad));
  scan.angle_increment_rad = static_cast<float>(kTurn_rad / 720);
  scan.beams = beams;
  return scan;
}

// A mirror that turns evenly; each scan begins where the one before ended, except at a break.
std::vector<LaserScan> parts(std::size_t count, double first_rad, std::size_t left_out = std::size_t(-1)) {
  std::vector<LaserScan> scans;
  std::size_t range = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == left_out) continue;
    LaserScan scan;
    const double beam = double(i) * kBeams;
    scan.first_beam_s = beam * kTimeIncrement_s;
    scan.time_increment_s = kTimeIncrement_s;
    scan.angle_min_rad = std::remainder(first_rad + beam * kTurn_rad / 720, kTurn_rad);
    scan.angle_increment_rad = kTurn_rad / 720;
    scan.first_range = range;
    scan.beams = kBeams;
    range += kBeams;
    scans.push_back(scan);
  }
  return scans;
}

TEST(Turns, MessagesThatCoverPartsOfATurnAreCounted) {
  std::vector<RawScan> messages;
  for (int i = 0; i < 36; ++i) messages.push_back(message(-3 + i * kTurn_rad / 12, kBeams));
  EXPECT_NEAR(turns_of_messages(messages).per_message, 1.0 / 12, 1e-6);
  EXPECT_FALSE(turns_of_messages(messages).backwards);
  std::ranges::reverse(messages);
  EXPECT_NEAR(turns_of_messages(messages).per_message, 1.0 / 12, 1e-6);
  EXPECT_TRUE(turns_of_messages(messages).backwards);
}

TEST(Turns, MessagesThatBeginInOneDirectionAreATurnEach) {
  for (const std::uint32_t beams : {200U, 540U, 720U})
    EXPECT_EQ(turns_of_messages(std::vector<RawScan>(20, message(-2, beams))).per_message, 1) << beams;
}

// Two parts of 135 deg, then a blind sector of 90 deg: by their angles they follow each other both ways.
TEST(Turns, TwoPartsBesideABlindSectorFollowEachOtherAsTheirStampsSay) {
  for (const bool backwards : {false, true}) {
    std::vector<RawScan> messages;
    for (int i = 0; i < 40; ++i) {
      const bool second = i % 2 == 1;
      messages.push_back(message((second != backwards ? 0 : -0.375) * kTurn_rad, 270));
      messages.back().stamps.header_ns = 1'000'000'000 + i / 2 * 100'000'000 + (second ? 37'500'000 : 0);
    }
    const MessageTurns turns = turns_of_messages(messages);
    EXPECT_NEAR(turns.per_message, 0.375, 1e-6);
    EXPECT_EQ(turns.backwards, backwards);
  }
}

TEST(Turns, PartsArePutTogetherToWholeTurns) {
  const std::vector<LaserScan> turns = whole_turns(parts(36, -3));
  ASSERT_EQ(turns.size(), 3U);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    EXPECT_EQ(turns[i].beams, 720U);
    EXPECT_EQ(turns[i].first_range, i * 720);
    EXPECT_NEAR(turns[i].first_beam_s, double(i) * 0.1, 1e-9);
    EXPECT_NEAR(turns[i].time_increment_s, kTimeIncrement_s, 1e-12);
    EXPECT_NEAR(std::remainder(turns[i].angle_min_rad + 3, kTurn_rad), 0, 1e-9);
  }
}

TEST(Turns, BehindALostPartATurnBeginsAgain) {
  const std::vector<LaserScan> turns = whole_turns(parts(36, -3, 15));
  ASSERT_EQ(turns.size(), 4U);
  EXPECT_EQ(turns[0].beams, 720U);
  EXPECT_EQ(turns[1].beams, 3 * kBeams);
  EXPECT_EQ(turns[2].beams, 8 * kBeams);
  EXPECT_NEAR(turns[2].first_beam_s, 16 * kBeams * kTimeIncrement_s, 1e-9);
  EXPECT_NEAR(std::remainder(turns[2].angle_min_rad - (-3 + 4 * kTurn_rad / 12), kTurn_rad), 0, 1e-9);
  EXPECT_EQ(turns[3].beams, 720U);
}

TEST(Turns, MessagesThatBeginElsewhereEachTimeAreCutInOneDirection) {
  std::vector<LaserScan> scans = parts(40, 1);
  for (LaserScan& scan : scans) {  // 100 beams each: no message begins where another one did
    const auto i = std::size_t(&scan - scans.data());
    scan.beams = 100;
    scan.first_range = i * 100;
    scan.first_beam_s = double(i) * 100 * kTimeIncrement_s;
    scan.angle_min_rad = std::remainder(1 + double(i) * 100 * kTurn_rad / 720, kTurn_rad);
  }
  const std::vector<LaserScan> turns = whole_turns(scans);
  ASSERT_EQ(turns.size(), 6U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(turns[i].beams, 720U);
    EXPECT_NEAR(turns[i].first_beam_s, double(i) * 0.1, 1e-9);
    EXPECT_NEAR(std::remainder(turns[i].angle_min_rad - 1, kTurn_rad), 0, 1e-9);
  }
  EXPECT_EQ(turns[5].beams, 400U);
}

}  // namespace
}  // namespace sweepscope
