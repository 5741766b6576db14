#include "core/campaign/expected_offset.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

TEST(ExpectedOffset, IsReadInEveryWayOfWritingIt) {
  for (const char* text :
       {"24+-0.5", "24 ± 0.5", "24±0.5", " 24 +/- 0.5 ms", "24ms+-0.5ms", "24.0 +- 5e-1"}) {
    const auto expected = parse_expected_offset(text);
    ASSERT_TRUE(expected) << text;
    EXPECT_EQ(expected->offset_ms, 24) << text;
    EXPECT_EQ(expected->tolerance_ms, 0.5) << text;
  }
  EXPECT_EQ(parse_expected_offset("-3.25+-1")->offset_ms, -3.25);
}

TEST(ExpectedOffset, AnythingElseIsRefusedWithTheWayToWriteIt) {
  for (const char* text : {"", "24", "24,5", "24,5+-0,5", "24+-0", "24+--1", "24+-", "+-1", "24+-nan",
                           "inf+-1", "24+-1 s", "24+-1+-1", "24-1"}) {
    const auto expected = parse_expected_offset(text);
    ASSERT_FALSE(expected) << text;
    EXPECT_EQ(expected.error().code, ExitCode::kWrongUsage) << text;
    EXPECT_NE(expected.error().message.find("such as 24+-0.5"), std::string::npos) << text;
  }
}

TEST(ExpectedOffset, HoldsUpToItsToleranceAndNotBeyond) {
  const ExpectedOffset expected{24, 0.5};
  EXPECT_TRUE(expected.holds(24));
  EXPECT_TRUE(expected.holds(24.5));
  EXPECT_TRUE(expected.holds(23.5));
  EXPECT_FALSE(expected.holds(24.500001));
  EXPECT_FALSE(expected.holds(23.499999));
  EXPECT_TRUE((ExpectedOffset{0.3, 0.1}.holds(0.2))) << "0.3 - 0.1 is not 0.2 in binary";
}

}  // namespace
}  // namespace sweepscope
