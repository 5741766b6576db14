// The parts of a picture that a page needs.
#include "ui/serve/frame_coder.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope::ui {
namespace {

using std::chrono::milliseconds;

class FrameCoding : public test::FolderTest {
 protected:
  /// A picture that no compression makes small.
  static std::shared_ptr<Image> noise(int width, int height, unsigned seed) {
    auto image = std::make_shared<Image>(width, height);
    std::mt19937 random(seed);
    for (std::uint8_t& byte : image->rgba) byte = static_cast<std::uint8_t>(random());
    image->make_opaque();
    return image;
  }

  /// What the page shows after these parts, where they are PNG.
  void draw(const std::vector<FramePart>& parts) {
    for (const FramePart& part : parts) {
      if (part.format != FramePart::Format::kPng) continue;
      ASSERT_TRUE(write_file(folder_ / "part.png", part.bytes));
      const Image image = read_png(folder_ / "part.png").value();
      ASSERT_EQ(image.width_px, part.place.width);
      for (int y = 0; y < part.place.height; ++y)
        std::copy_n(image.pixel(0, y), Image::kChannels * static_cast<std::size_t>(image.width_px),
                    page_.pixel(part.place.left, part.place.top + y));
    }
  }

  FrameCoder coder_;
  FrameCoder::Time now_{};
  Image page_;
};

TEST_F(FrameCoding, WhatRestsIsShownAsItWasDrawnToThePixel) {
  const auto picture = noise(700, 500, 1);
  page_ = Image(700, 500);
  const auto first = coder_.next(picture, now_);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].format, FramePart::Format::kJpeg);
  EXPECT_FALSE(coder_.exact());
  for (int i = 0; i < 100 && !coder_.exact(); ++i) {
    now_ = std::max(now_, *coder_.rested_at());
    const auto parts = coder_.next(picture, now_);
    ASSERT_FALSE(parts.empty());
    draw(parts);
  }
  EXPECT_TRUE(coder_.exact());
  EXPECT_EQ(page_, *picture);
  EXPECT_TRUE(coder_.next(picture, now_ + milliseconds(5000)).empty());
}

TEST_F(FrameCoding, OnlyWhatChangedIsSent) {
  const auto picture = noise(640, 480, 1);
  (void)coder_.next(picture, now_);
  const auto next = std::make_shared<Image>(*picture);
  next->pixel(300, 200)[1] ^= 1;
  const auto parts = coder_.next(next, now_ + milliseconds(50));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].place, (ImageRect{288, 192, 32, 32}));
  EXPECT_EQ(parts[0].format, FramePart::Format::kPng) << "a little change is exact at once";
}

TEST_F(FrameCoding, AnEqualPictureNeedsNothing) {
  const auto picture = noise(320, 240, 1);
  (void)coder_.next(picture, now_);
  EXPECT_TRUE(coder_.next(std::make_shared<Image>(*picture), now_).empty());
}

TEST_F(FrameCoding, LargeFramesLoseQualityAndSmallOnesGainIt) {
  const int before = coder_.quality();
  for (unsigned i = 0; i < 3; ++i) (void)coder_.next(noise(1280, 720, i), now_);
  const int noisy = coder_.quality();
  EXPECT_LT(noisy, before);
  for (int i = 0; i < 6; ++i) {
    auto plain = std::make_shared<Image>(1280, 720);
    std::fill(plain->rgba.begin(), plain->rgba.end(), static_cast<std::uint8_t>(40 * i));
    plain->make_opaque();
    (void)coder_.next(plain, now_);
  }
  EXPECT_EQ(coder_.quality(), before);
}

TEST(Cover, RowsThatAreAlikeAreOneRectangle) {
  const std::vector<bool> marked{true,  true,  false, true,   //
                                 true,  true,  false, false,  //
                                 false, false, false, true};
  EXPECT_EQ(cover(marked, 4, 24), (std::vector<ImageRect>{{0, 0, 2, 2}, {3, 0, 1, 1}, {3, 2, 1, 1}}));
  EXPECT_EQ(cover(marked, 4, 2), (std::vector<ImageRect>{{0, 0, 4, 3}}));
  EXPECT_TRUE(cover({false, false}, 2, 24).empty());
}

}  // namespace
}  // namespace sweepscope::ui
