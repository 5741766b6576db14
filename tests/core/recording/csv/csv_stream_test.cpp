#include "core/recording/csv/csv_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

const Rig kRig;

RawRecording heard(std::initializer_list<const char*> lines) {
  CsvStream stream("stream", kRig);
  for (const char* line : lines) {
    const auto taken = stream.take(line);
    EXPECT_TRUE(taken) << taken.error().message;
  }
  return stream.heard();
}

constexpr const char* kScanNames = "scan,stamp_s,angle_min_rad,angle_increment_rad,time_increment_s,ranges_m";
constexpr const char* kMotorNames = "motor,stamp_s,angle_deg";

TEST(CsvStream, LinesOfBothTablesComeMixed) {
  const RawRecording raw = heard({"# my rig", kScanNames, "scan,12.000000005,-1.5,0.25,1e-4,1 nan 3.5", "",
                                  kMotorNames, "motor,12.01,90\r", "scan,12.025,-1.5,0.25,1e-4,4 5 6"});
  ASSERT_EQ(raw.lasers.size(), 1U);
  const RawLaser& laser = raw.lasers[0];
  ASSERT_EQ(laser.scans.size(), 2U);
  EXPECT_EQ(laser.scans[0].stamps.header_ns, 12'000'000'005);
  EXPECT_EQ(laser.scans[0].beams, 3U);
  EXPECT_FLOAT_EQ(laser.scans[0].angle_min_rad, -1.5F);
  EXPECT_TRUE(std::isnan(laser.ranges_m[1]));
  EXPECT_FLOAT_EQ(laser.ranges_m[5], 6);
  ASSERT_EQ(raw.joints.size(), 1U);
  ASSERT_EQ(raw.joints[0].positions.size(), 1U);
  EXPECT_NEAR(raw.joints[0].positions[0], 1.5707963, 1e-6);
  EXPECT_TRUE(raw.warnings.empty());
}

TEST(CsvStream, WhatIsWrongInOneLineIsSkippedAndSaid) {
  const RawRecording raw = heard({kScanNames, "scan,12,-1.5,0.25,1e-4", "scan,12,-1.5,x,1e-4,1 2 3",
                                  "scan,12,-1.5,0.25,1e-4,1 2 3", "what is this", kMotorNames, "motor,,"});
  EXPECT_EQ(raw.lasers.at(0).scans.size(), 1U);
  EXPECT_EQ(raw.lasers.at(0).ranges_m.size(), 3U);
  EXPECT_TRUE(raw.joints.empty());
  ASSERT_EQ(raw.warnings.size(), 1U);
  EXPECT_EQ(raw.warnings[0], "4 lines were skipped: stream: line 2 has 4 cells, and line 1 names 5 columns");
}

TEST(CsvStream, ADriverThatBeginsAnewNamesItsColumnsAgain) {
  const RawRecording raw = heard({kMotorNames, "motor,1,2", kMotorNames, "motor,2,3"});
  EXPECT_EQ(raw.joints.at(0).positions.size(), 2U);
  EXPECT_TRUE(raw.warnings.empty());
}

TEST(CsvStream, ColumnsThatCannotBeUsedFail) {
  for (const auto& [line, why] : {std::pair("scan,stamp_s,ranges_m", "has no column angle_min_rad"),
                                  {"motor,stamp_s,angle", "has no column angle_rad or angle_deg"},
                                  {"motor,angle_rad", "has no column stamp_s or receive_s"},
                                  {"motor,stamp_s,stamp_s,angle_rad", "names column stamp_s twice"}}) {
    CsvStream stream("stream", kRig);
    const auto taken = stream.take(line);
    ASSERT_FALSE(taken) << line;
    EXPECT_EQ(taken.error().code, ExitCode::kUnreadableInput);
    EXPECT_NE(taken.error().message.find(why), std::string::npos) << taken.error().message;
    EXPECT_NE(taken.error().message.find("stream: line 1"), std::string::npos) << taken.error().message;
  }
}

}  // namespace
}  // namespace sweepscope
