// Stamps that are moved: by how much, and where they lie in a message.
#include <gtest/gtest.h>

#include "core/apply/clock_shift.hpp"
#include "core/apply/provenance.hpp"
#include "core/apply/stamp_shift.hpp"
#include "core/numbers.hpp"
#include "tests/core/recording/message_bytes.hpp"

namespace sweepscope {
namespace {

using test::MessageBytes;

constexpr std::int64_t kMs_ns = 1'000'000;

TEST(ClockShift, TheMotorsStampIsTheLasersPlusTheOffset) {
  const ClockShift shift(0.024);
  EXPECT_EQ(shift.motor_ns(1000 * kSecond_ns), 1000 * kSecond_ns + 24 * kMs_ns);
  EXPECT_EQ(shift.laser_ns(1000 * kSecond_ns), 1000 * kSecond_ns - 24 * kMs_ns);
}

TEST(ClockShift, ADriftAndAStepAreAppliedWhereTheyAre) {
  const std::int64_t middle_ns = 1000 * kSecond_ns;
  const ClockShift shift(0.024, middle_ns, 100e-6, {{990 * kSecond_ns, 0.002}, {1010 * kSecond_ns, 0.005}});
  EXPECT_NEAR(shift.offset_s(middle_ns), 0.024, 1e-12);
  EXPECT_NEAR(shift.offset_s(middle_ns + 5 * kSecond_ns), 0.0245, 1e-12);
  EXPECT_NEAR(shift.offset_s(middle_ns + 20 * kSecond_ns), 0.024 + 0.002 + 0.005, 1e-12);
  EXPECT_NEAR(shift.offset_s(middle_ns - 20 * kSecond_ns), 0.024 - 0.002 - 0.002, 1e-12);
  for (const int after_s : {-100, -9, 0, 5, 20, 3000}) {
    const std::int64_t laser_ns = middle_ns + after_s * kSecond_ns;
    EXPECT_LE(std::abs(shift.laser_ns(shift.motor_ns(laser_ns)) - laser_ns), 1) << after_s;
  }
}

std::string moved(MessageKind kind, Encoding encoding, const std::string& joint, std::string bytes,
                  StampShift expected, std::int64_t by_ns = -24 * kMs_ns) {
  const auto map = [&](std::int64_t ns) { return ns + by_ns; };
  EXPECT_EQ(shift_header_stamps(kind, encoding, joint, map, std::as_writable_bytes(std::span(bytes))),
            expected);
  return bytes;
}

std::string joint_state(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds) {
  MessageBytes bytes(form);
  bytes.header(seconds, nanoseconds, "base").number(std::uint32_t{1}).text("roll");
  return bytes.array<double>({1.5}).array<double>({}).array<double>({}).bytes();
}

TEST(StampShift, OnlyTheStampOfAMessageChanges) {
  for (const auto form : {MessageBytes::kRos1, MessageBytes::kCdr, MessageBytes::kCdrBigEndian}) {
    const auto encoding = form == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr;
    EXPECT_EQ(moved(MessageKind::kJointState, encoding, "roll", joint_state(form, 100, 10'000'000),
                    StampShift::kShifted),
              joint_state(form, 99, 986'000'000));
  }
}

std::string transforms(MessageBytes::Form form, std::uint32_t second_s, std::uint32_t second_ns) {
  MessageBytes bytes(form);
  bytes.number(std::uint32_t{2});
  const auto pose = [&] {
    for (int i = 0; i < 7; ++i) bytes.number(i == 6 ? 1.0 : 0.0);
  };
  bytes.header(100, 10'000'000, "odom").text("base");
  pose();
  bytes.header(second_s, second_ns, "").text("scanner");
  pose();
  return bytes.bytes();
}

TEST(StampShift, OfTransformsOnlyThatOfTheMotorsFrameChanges) {
  for (const auto form : {MessageBytes::kRos1, MessageBytes::kCdr, MessageBytes::kCdrBigEndian}) {
    const auto encoding = form == MessageBytes::kRos1 ? Encoding::kRos1 : Encoding::kCdr;
    EXPECT_EQ(moved(MessageKind::kTransforms, encoding, "scanner", transforms(form, 100, 30'000'000),
                    StampShift::kShifted),
              transforms(form, 100, 6'000'000));
  }
}

TEST(StampShift, WhatCannotBeMovedStaysAndSaysWhy) {
  const std::string early = joint_state(MessageBytes::kRos1, 0, 10'000'000);
  EXPECT_EQ(moved(MessageKind::kJointState, Encoding::kRos1, "roll", early, StampShift::kOutOfRange), early);
  const std::string late = joint_state(MessageBytes::kCdr, 2'147'483'647, 999'000'000);
  EXPECT_EQ(
      moved(MessageKind::kJointState, Encoding::kCdr, "roll", late, StampShift::kOutOfRange, 24 * kMs_ns),
      late);
  const std::string none = joint_state(MessageBytes::kRos1, 0, 0);
  EXPECT_EQ(moved(MessageKind::kJointState, Encoding::kRos1, "roll", none, StampShift::kNone), none);
  EXPECT_EQ(moved(MessageKind::kJointState, Encoding::kCdr, "roll", "short", StampShift::kMalformed),
            "short");
  const std::string number(8, '\1');
  EXPECT_EQ(moved(MessageKind::kFieldsWithoutHeader, Encoding::kRos1, "data", number, StampShift::kNone),
            number);
}

TEST(AppliedOffset, IsReadFromAnEstimateWithItsCourse) {
  const auto constant = parse_applied_offset(
      R"({"schema":"sweepscope.estimate/1","offset_ms":24.5,"sigma_ms":null,"drift_ppm":9})", "E");
  ASSERT_TRUE(constant);
  EXPECT_DOUBLE_EQ(constant->offset_s, 0.0245);
  EXPECT_FALSE(constant->changes());
  const auto course = parse_applied_offset(
      R"({"schema":"sweepscope.estimate/1","offset_ms":24,"sigma_ms":0.1,"over_time":[],"middle_s":100,
          "rate_ppm":50,"jumps":[{"from_s":40,"to_s":60,"jump_ms":-3,"sigma_ms":0.2}]})",
      "E");
  ASSERT_TRUE(course);
  EXPECT_TRUE(course->changes());
  EXPECT_DOUBLE_EQ(*course->middle_s, 100);
  EXPECT_DOUBLE_EQ(course->rate, 50e-6);
  ASSERT_EQ(course->jumps.size(), 1U);
  EXPECT_DOUBLE_EQ(course->jumps[0].time_s, 50);
  EXPECT_DOUBLE_EQ(course->jumps[0].size_s, -0.003);
}

TEST(AppliedOffset, AnEstimateThatHasNoneIsRefusedWithItsReason) {
  const auto refused = parse_applied_offset(
      R"({"schema":"sweepscope.estimate/1","offset_ms":null,"reasons":["The clocks drift apart."]})",
      "E.json");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ExitCode::kNotIdentifiable);
  EXPECT_EQ(refused.error().message, "E.json: the estimate has no offset: The clocks drift apart.");
  for (const char* bad : {"", "[]", "{}", R"({"schema":"sweepscope.estimate/1"})",
                          R"({"schema":"sweepscope.estimate/1","offset_ms":"24"})",
                          R"({"schema":"sweepscope.estimate/1","offset_ms":24,"rate_ppm":1e9})",
                          R"({"schema":"sweepscope.estimate/1","offset_ms":24,"jumps":[{"from_s":1}]})"}) {
    const auto unreadable = parse_applied_offset(bad, "E.json");
    ASSERT_FALSE(unreadable) << bad;
    EXPECT_EQ(unreadable.error().code, ExitCode::kUnreadableInput) << bad;
  }
}

}  // namespace
}  // namespace sweepscope
