#include "render/image_difference.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

Image grey_image(int width, int height) {
  Image image(width, height);
  std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t{100});
  return image;
}

TEST(ImageDifference, EqualImagesPass) {
  const Image image = grey_image(100, 50);
  const auto difference = compare_images(image, image);
  EXPECT_TRUE(difference.passes);
  EXPECT_EQ(describe(difference), "The images agree; the largest step in a channel is 0.");
}

TEST(ImageDifference, AnotherSizeFails) {
  EXPECT_FALSE(compare_images(grey_image(100, 50), grey_image(50, 100)).passes);
}

TEST(ImageDifference, StepsOfEightEverywherePassAndNineFail) {
  const Image expected = grey_image(64, 64);
  Image actual = expected;
  for (auto& channel : actual.rgba) channel = 108;
  EXPECT_TRUE(compare_images(actual, expected).passes);
  for (auto& channel : actual.rgba) channel = 109;
  EXPECT_FALSE(compare_images(actual, expected).passes);
}

TEST(ImageDifference, OnePixelInTenThousandMayJumpAndTwoMayNot) {
  const Image expected = grey_image(100, 100);
  Image actual = expected;
  actual.pixel(10, 10)[1] = 255;
  EXPECT_TRUE(compare_images(actual, expected).passes);
  actual.pixel(80, 80)[2] = 0;
  const auto difference = compare_images(actual, expected);
  EXPECT_FALSE(difference.passes);
  EXPECT_EQ(difference.differing_pixels, 2U);
  EXPECT_EQ(difference.largest_channel_difference, 155);
}

TEST(ImageDifference, ASmallPatchInALargeImageFailsByItsTile) {
  const Image expected = grey_image(2000, 1000);
  Image actual = expected;
  for (int i = 0; i < 60; ++i) actual.pixel(640 + i % 10, 320 + i / 10)[0] = 0;
  const auto difference = compare_images(actual, expected);
  EXPECT_LT(difference.differing_fraction, 1e-4);
  EXPECT_FALSE(difference.passes);
  EXPECT_EQ(difference.worst_tile_x_px, 640);
  EXPECT_EQ(difference.worst_tile_y_px, 320);
}

TEST(ImageDifference, ThePictureIsBlackWhereBothAgree) {
  const Image expected = grey_image(10, 10);
  Image actual = expected;
  actual.pixel(3, 4)[0] = 110;
  const Image picture = difference_picture(actual, expected);
  EXPECT_EQ(picture.pixel(0, 0)[0], 0);
  EXPECT_EQ(picture.pixel(3, 4)[0], 80);
}

}  // namespace
}  // namespace sweepscope
