#include "render/images/image_difference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>

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

TEST(ImageDifference, EightPixelsOfATileMayJumpAndNineMayNot) {
  const Image expected = grey_image(2000, 1000);
  Image actual = expected;
  for (int i = 0; i < 8; ++i) actual.pixel(640 + i, 320)[0] = 0;
  EXPECT_TRUE(compare_images(actual, expected).passes);
  actual.pixel(648, 320)[0] = 0;
  EXPECT_FALSE(compare_images(actual, expected).passes);
}

TEST(ImageDifference, ThePictureIsBlackWhereBothAgree) {
  const Image expected = grey_image(10, 10);
  Image actual = expected;
  actual.pixel(3, 4)[0] = 110;
  const Image picture = difference_picture(actual, expected);
  EXPECT_EQ(picture.pixel(0, 0)[0], 0);
  EXPECT_EQ(picture.pixel(3, 4)[0], 80);
}

/// The baselines of the screenshot tests, as they are and spoiled.
class SpoiledBaseline : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto path = std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "screenshots" / GetParam();
    const auto image = read_png(path);
    ASSERT_TRUE(image) << image.error().message;
    expected_ = actual_ = *image;
  }
  bool passes() const { return compare_images(actual_, expected_).passes; }

  /// Covers a part with the colour of the picture's top left corner.
  void erase(int left, int top, int width, int height) {
    for (int y = top; y < top + height; ++y) {
      for (int x = left; x < left + width; ++x) std::copy_n(expected_.pixel(0, 0), 4, actual_.pixel(x, y));
    }
  }

  bool is_blank(int row) const {
    for (int x = 0; x < expected_.width_px; ++x) {
      if (!std::equal(expected_.pixel(0, 0), expected_.pixel(0, 0) + 4, expected_.pixel(x, row)))
        return false;
    }
    return true;
  }
  /// The rows where the title begins and the footer ends.
  int first_row() const {
    int row = 0;
    while (row + 1 < expected_.height_px && is_blank(row)) ++row;
    return row;
  }
  int last_row() const {
    int row = expected_.height_px - 1;
    while (row > 0 && is_blank(row)) --row;
    return row;
  }

  Image expected_, actual_;
};

TEST_P(SpoiledBaseline, PassesAsItIs) {
  EXPECT_TRUE(passes());
}

TEST_P(SpoiledBaseline, AShiftOfThreePixelsFails) {
  for (int y = 0; y < actual_.height_px; ++y) {
    for (int x = 3; x < actual_.width_px; ++x) {
      std::copy_n(expected_.pixel(x - 3, y), 4, actual_.pixel(x, y));
    }
  }
  EXPECT_FALSE(passes());
}

TEST_P(SpoiledBaseline, AMissingTitleOrFooterFails) {
  erase(0, first_row(), actual_.width_px, 20);
  EXPECT_FALSE(passes());
  actual_ = expected_;
  erase(0, last_row() - 12, actual_.width_px, 13);
  EXPECT_FALSE(passes());
}

TEST_P(SpoiledBaseline, ATitleCutInHalfFails) {
  erase(0, first_row(), actual_.width_px, 6);
  EXPECT_FALSE(passes());
}

TEST_P(SpoiledBaseline, OtherColoursFail) {
  for (std::size_t i = 0; i < actual_.rgba.size(); i += Image::kChannels) {
    std::swap(actual_.rgba[i], actual_.rgba[i + 2]);
  }
  EXPECT_FALSE(passes());
}

TEST_P(SpoiledBaseline, ABlankPictureFails) {
  erase(0, 0, actual_.width_px, actual_.height_px);
  EXPECT_FALSE(passes());
}

TEST_P(SpoiledBaseline, AnEmptyPanelFails) {
  erase(actual_.width_px / 2, actual_.height_px / 4, actual_.width_px / 3, actual_.height_px / 2);
  EXPECT_FALSE(passes());
}

INSTANTIATE_TEST_SUITE_P(Pictures, SpoiledBaseline,
                         testing::Values("maps-two-moving-curve.png", "maps-four.png", "colour-by-time.png",
                                         "view-isometric.png", "figure-curves-standing.png",
                                         "figure-profile.png", "figure-scan.png"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == '-' || c == '.'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace sweepscope
