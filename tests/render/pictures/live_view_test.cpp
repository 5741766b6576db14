#include "render/pictures/live_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/images/image_difference.hpp"

namespace sweepscope {
namespace {

/// Points of a plane seen from above: every `step`th of 150,000, in the order of its rows.
LivePointsPtr plane(std::size_t step, double shift_m = 0) {
  auto points = std::make_shared<LivePoints>();
  for (std::size_t i = 0; i < 150000; i += step) {
    const double x_m = static_cast<double>(i % 500) / 50 - 5 + shift_m,
                 y_m = static_cast<double>(i / 500) / 30 - 5;
    points->xyz_m.push_back({static_cast<float>(x_m), static_cast<float>(y_m), 0});
    points->rgb.push_back({static_cast<std::uint8_t>(i % 250), 200, 80});
  }
  return points;
}

class Live : public testing::Test {
 protected:
  void SetUp() override { set_up(view_); }
  static void set_up(LiveView& view) {
    view.resize(300, 260);
    view.set_background({10, 20, 30});
    Camera camera;
    camera.position_m = {0, 0, 100};
    camera.view_height_m = 12;
    view.set_camera(camera);
  }
  /// As it is drawn alone, without a pause.
  Image drawn_at_once(const LivePointsPtr& coarse, const LivePointsPtr& full, LiveView::Points points) {
    LiveView other(*context_);
    set_up(other);
    other.show(coarse, full);
    other.draw(60);
    return other.picture(points);
  }
  Image shown() const { return view_.picture(LiveView::Points::kAll); }

  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(64, 64);
  LiveView view_{*context_};
};

TEST_F(Live, ShowsTheCoarseOrTheWholePictureAndNothingBetweenThem) {
  const LivePointsPtr coarse = plane(20), full = plane(1);
  const Image thinned = drawn_at_once(coarse, full, LiveView::Points::kCoarse);
  const Image whole = drawn_at_once(coarse, full, LiveView::Points::kAll);
  ASSERT_FALSE(compare_images(thinned, whole).passes);
  view_.show(coarse, full);
  int drawings = 0;
  for (; !view_.done(); ++drawings) {
    view_.draw(0);
    EXPECT_EQ(shown(), view_.has_all_points() ? whole : thinned) << "after drawing " << drawings + 1;
  }
  EXPECT_GT(drawings, 3);  // all points came in several slices
  EXPECT_TRUE(view_.has_all_points());
}

TEST_F(Live, AChangeShowsTheCoarsePointsOfTheNewStateAtOnce) {
  const LivePointsPtr coarse = plane(20), full = plane(1), moved = plane(20, 1);
  view_.show(coarse, full);
  view_.draw(60);
  view_.show(moved, nullptr);
  view_.draw(0);
  EXPECT_FALSE(view_.has_all_points());
  EXPECT_EQ(shown(), drawn_at_once(moved, nullptr, LiveView::Points::kCoarse));
}

TEST_F(Live, WhatMovesHasNoPictureOfAllPoints) {
  view_.show(plane(20), plane(1));
  view_.set_moving(true);
  view_.draw(60);
  EXPECT_TRUE(view_.done());
  EXPECT_FALSE(view_.has_all_points());
  view_.set_moving(false);
  view_.draw(60);
  EXPECT_TRUE(view_.has_all_points());
}

TEST_F(Live, TheCoarsePictureRemainsWhileAllPointsAreShown) {
  const LivePointsPtr coarse = plane(20), full = plane(1);
  view_.show(coarse, full);
  view_.draw(60);
  EXPECT_EQ(view_.picture(LiveView::Points::kCoarse), drawn_at_once(coarse, full, LiveView::Points::kCoarse));
}

TEST_F(Live, AnotherSizeGivesAWholePictureOfThatSize) {
  view_.show(plane(20), plane(1));
  view_.draw(60);
  view_.resize(200, 180);
  view_.draw(0);
  EXPECT_FALSE(view_.has_all_points());
  EXPECT_EQ(shown().width_px, 200);
  EXPECT_EQ(shown().height_px, 180);
}

}  // namespace
}  // namespace sweepscope
