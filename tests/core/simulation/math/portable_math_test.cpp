#include "core/simulation/math/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope::simulation {
namespace {

TEST(PortableMath, SineAndCosineAgreeWithTheLibrary) {
  for (double angle_rad = -50; angle_rad < 50; angle_rad += 0.0137) {
    const SinCos computed = sin_cos(angle_rad);
    EXPECT_NEAR(computed.sin, std::sin(angle_rad), 2e-15);
    EXPECT_NEAR(computed.cos, std::cos(angle_rad), 2e-15);
  }
}

TEST(PortableMath, LogarithmAgreesWithTheLibrary) {
  for (double x = 1e-12; x < 1e6; x *= 1.7)
    EXPECT_NEAR(natural_log(x), std::log(x), 1e-14 * (1 + std::abs(std::log(x))));
}

TEST(Random, IsTheSameStreamForEver) {
  Random random(1, 2, 3);
  EXPECT_EQ(random.next(), 4595676738360073315ULL);
  EXPECT_EQ(Random(1, 2, 3).next(), Random(1, 2, 3).next());
}

TEST(Random, StreamsDifferBySeedPurposeAndNumber) {
  const std::uint64_t value = Random(1, 2, 3).next();
  EXPECT_NE(value, Random(2, 2, 3).next());
  EXPECT_NE(value, Random(1, 3, 3).next());
  EXPECT_NE(value, Random(1, 2, 4).next());
  EXPECT_NE(Random(1, 2, 3).next(), Random(1, 3, 2).next());
}

TEST(Random, NormalValuesHaveMeanZeroAndDeviationOne) {
  Random random(7, 0, 0);
  double sum = 0, squares = 0, beyond_two = 0;
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    if (std::abs(x) > 2) ++beyond_two;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.02);
  EXPECT_NEAR(squares / kDraws, 1, 0.03);
  EXPECT_NEAR(beyond_two / kDraws, 0.0455, 0.005);
}

}  // namespace
}  // namespace sweepscope::simulation
