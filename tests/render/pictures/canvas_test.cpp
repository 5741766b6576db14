#include "render/pictures/canvas.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace sweepscope {
namespace {

Picture small_picture() {
  Picture picture{80, 64, {10, 20, 30}, {}, {}};
  picture.marks.fill({10, 10, 20, 20}, {200, 0, 0});
  return picture;
}

TEST(Canvas, OffScreenDrawsWhatDrawDraws) {
  const auto canvas = make_canvas(Backend::kOffscreen).value();
  EXPECT_EQ(canvas->draw(small_picture()).value(), draw(small_picture()).value());
}

TEST(Canvas, TheNullOneGivesTheBackgroundWithoutDrawing) {
  const Image image = make_canvas(Backend::kNull).value()->draw(small_picture()).value();
  EXPECT_EQ(image.width_px, 80);
  EXPECT_EQ(image.height_px, 64);
  EXPECT_EQ(image.pixel(15, 15)[0], 10);
  EXPECT_TRUE(image.opaque());
}

TEST(Canvas, EveryBackEndRefusesTheSameSizes) {
  Picture huge = small_picture();
  huge.width_px = kMaxPictureSidePx + 1;
  for (const Backend one : {Backend::kOffscreen, Backend::kNull}) {
    EXPECT_EQ(make_canvas(one).value()->draw(huge).error().code, ExitCode::kWrongUsage);
  }
}

TEST(Canvas, AWindowWithoutADisplayIsRefusedInASentence) {
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  const auto canvas = make_canvas(Backend::kWindow);
  ASSERT_FALSE(canvas);
  EXPECT_FALSE(canvas.error().message.empty());
}

TEST(Canvas, BackEndsHaveNames) {
  EXPECT_EQ(backend("window").value(), Backend::kWindow);
  EXPECT_EQ(backend("paper").error().code, ExitCode::kWrongUsage);
}

}  // namespace
}  // namespace sweepscope
