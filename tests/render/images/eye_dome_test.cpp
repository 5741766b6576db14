#include "render/images/eye_dome.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <random>

namespace sweepscope {
namespace {

constexpr int kSide = 96;
constexpr std::uint8_t kGrey = 120;
constexpr DepthScale kScale{.orthographic = true, .near_m = 0, .far_m = 10, .metres_per_px = 0.05};

Image grey() {
  Image image(kSide, kSide);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = i % 4 == 3 ? 255 : kGrey;
  return image;
}

/// Depths of a surface, in metres from the near plane, where `drawn` says that there is a point.
template <typename Surface, typename Drawn>
DepthImage depths(const Surface& depth_m, const Drawn& drawn) {
  DepthImage image(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x)
      if (drawn(x, y)) image.row(y)[x] = static_cast<float>(depth_m(x, y) / kScale.far_m);
  }
  return image;
}
bool everywhere(int, int) {
  return true;
}

/// A block that stands 2 m before a wall.
double block(int x, int y) {
  return x >= 32 && x < 64 && y >= 32 && y < 64 ? 4 : 6;
}

int brightness(const Image& image, int x, int y) {
  return image.pixel(x, y)[0];
}

double mean_brightness(const Image& image, const DepthImage& depth) {
  double sum = 0, count = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (depth.row(y)[x] >= DepthImage::kEmpty) continue;
      sum += brightness(image, x, y);
      ++count;
    }
  }
  return sum / count;
}

TEST(EyeDome, DarkensWhatIsBehindAnEdgeAndNotItsFront) {
  const Image lit = with_lighting(grey(), depths(block, everywhere), kScale, {});
  EXPECT_LT(brightness(lit, 30, 48), 0.85 * kGrey);
  EXPECT_GE(brightness(lit, 33, 48), kGrey);
  EXPECT_EQ(brightness(lit, 48, 48), kGrey);  // the face itself
  EXPECT_EQ(brightness(lit, 10, 10), kGrey);  // and the wall away from it
}

TEST(EyeDome, APlaneKeepsItsColoursFromAnySide) {
  for (const double slope : {0.0, 0.02, 0.06}) {
    const auto plane = [&](int x, int y) { return 1 + slope * x + 0.5 * slope * y; };
    const Image lit = with_lighting(grey(), depths(plane, everywhere), kScale, {});
    EXPECT_EQ(lit, grey()) << slope;
  }
}

TEST(EyeDome, APlaneInPerspectiveKeepsItsColours) {
  const DepthScale scale{.orthographic = false, .near_m = 1, .far_m = 50, .pixels_per_slope = 300};
  DepthImage depth(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double distance_m = 8 / (1 - 0.4 * (x - 48) / 100.0);  // 1 / distance is linear in the picture
      depth.row(y)[x] =
          static_cast<float>(scale.far_m / (scale.far_m - scale.near_m) * (1 - scale.near_m / distance_m));
    }
  }
  EXPECT_EQ(with_lighting(grey(), depth, scale, {}), grey());
}

TEST(EyeDome, AnEdgeIsAsDarkInPerspectiveNearAndFar) {
  const auto darkest = [](double distance_m) {
    const DepthScale scale{.orthographic = false, .near_m = 1, .far_m = 100, .pixels_per_slope = 300};
    // Five pixels deep at its own distance, wherever it is.
    const double step_m = 5 * distance_m / scale.pixels_per_slope;
    DepthImage depth(kSide, kSide);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double here_m = distance_m + (x < 48 ? 0 : step_m);
        depth.row(y)[x] =
            static_cast<float>(scale.far_m / (scale.far_m - scale.near_m) * (1 - scale.near_m / here_m));
      }
    }
    return brightness(with_lighting(grey(), depth, scale, {.noise_m = 0}), 49, 48);
  };
  EXPECT_LT(darkest(5), 0.9 * kGrey);
  EXPECT_NEAR(darkest(5), darkest(50), 3);
}

TEST(EyeDome, GapsDarkenNothingAndKeepTheirColour) {
  const auto left = [](int x, int) { return x < 48; };  // nothing at all on the right
  EXPECT_EQ(with_lighting(grey(), depths([](int, int) { return 3.0; }, left), kScale, {}), grey());
}

TEST(EyeDome, TheNoiseOfTheScannerIsNoShape) {
  std::mt19937 random(1);
  const auto noisy = [&](int, int) {
    return 5 + 0.018 * (static_cast<double>(random() >> 8) / (1U << 24) - 0.5);
  };
  const DepthImage depth = depths(noisy, everywhere);
  const DepthScale close{.orthographic = true, .near_m = 0, .far_m = 10, .metres_per_px = 0.002};
  EXPECT_EQ(with_lighting(grey(), depth, close, {}), grey());
  EXPECT_NE(with_lighting(grey(), depth, close, {.splat_px = 0, .noise_m = 0}), grey());
}

TEST(EyeDome, MeanBrightnessStaysWithinAFifthAtAnyDensity) {
  for (const double density : {1.0, 0.8, 0.5, 0.3, 0.1, 0.03, 0.003}) {
    std::mt19937 random(7);
    // Two layers that show through each other, which is what makes sparse points black.
    const auto layers = [&](int x, int y) {
      return (random() % 2 == 0 ? 3 : 7) + 0.01 * x + 0.3 * std::sin(0.2 * y);
    };
    const auto drawn = [&](int, int) { return static_cast<double>(random() >> 8) / (1U << 24) < density; };
    const DepthImage sparse_layers = depths(layers, drawn), sparse_block = depths(block, drawn);
    EXPECT_NEAR(mean_brightness(with_lighting(grey(), sparse_block, kScale, {}), sparse_block), kGrey,
                0.2 * kGrey)
        << density;
    EXPECT_NEAR(mean_brightness(with_lighting(grey(), sparse_layers, kScale, {}), sparse_layers), kGrey,
                0.2 * kGrey)
        << density;
  }
}

TEST(EyeDome, NoPixelBecomesBlack) {
  std::mt19937 random(3);
  const auto rough = [&](int, int) { return 1 + 8.0 * (static_cast<double>(random() >> 8) / (1U << 24)); };
  const DepthImage depth = depths(rough, everywhere);
  const Image lit = with_lighting(grey(), depth, kScale, {.strength = 5});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      ASSERT_GE(brightness(lit, x, y), kGrey / 4 - 1);
      ASSERT_LE(brightness(lit, x, y), kGrey * 5 / 4 + 1);
    }
  }
}

TEST(EyeDome, IsTheSameForAnyNumberOfThreadsAndAnyWidth) {
  const DepthImage depth = depths(block, everywhere);
  const Image many = with_lighting(grey(), depth, kScale, {});
  tbb::task_arena one(1);
  Image alone;
  one.execute([&] { alone = with_lighting(grey(), depth, kScale, {}); });
  EXPECT_EQ(many, alone);
  // The last pixels of rows that are no multiple of what is computed at once.
  DepthImage narrow(kSide - 3, kSide);
  Image narrow_grey(kSide - 3, kSide);
  for (int y = 0; y < kSide; ++y) {
    std::copy_n(depth.row(y), kSide - 3, narrow.row(y));
    std::copy_n(grey().pixel(0, y), 4 * (kSide - 3), narrow_grey.pixel(0, y));
  }
  const Image lit = with_lighting(narrow_grey, narrow, kScale, {});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide - 10; ++x) ASSERT_EQ(brightness(lit, x, y), brightness(many, x, y));
    ASSERT_EQ(brightness(lit, kSide - 4, y), kGrey);
  }
}

TEST(EyeDome, WhatHasNoPointBecomesTransparent) {
  const DepthImage depth = depths([](int, int) { return 3.0; }, [](int x, int) { return x < 10; });
  const Image image = without_gaps(grey(), depth);
  EXPECT_EQ(image.pixel(9, 5)[3], 255);
  EXPECT_EQ(image.pixel(10, 5)[3], 0);
}

}  // namespace
}  // namespace sweepscope
