#include "core/recording/recording.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

TEST(MotorTrack, IsLinearBetweenSamples) {
  const MotorTrack track{{0.0, 0.1, 0.3}, {1.0, 2.0, 0.0}};
  EXPECT_DOUBLE_EQ(track.angle_at(0.05), 1.5);
  EXPECT_DOUBLE_EQ(track.angle_at(0.2), 1.0);
  EXPECT_DOUBLE_EQ(track.angle_at(0.3), 0.0);
}

TEST(MotorTrack, DoesNotCoverAcrossAGap) {
  const MotorTrack track{{0.0, 0.1, 0.3}, {1.0, 2.0, 0.0}};
  EXPECT_TRUE(track.covers(0.0, 0.1, 0.15));
  EXPECT_FALSE(track.covers(0.05, 0.2, 0.15));
  EXPECT_FALSE(track.covers(-0.01, 0.05, 0.15));
}

}  // namespace
}  // namespace sweepscope
