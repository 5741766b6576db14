#include <gtest/gtest.h>

#include "ui/model/view_camera.hpp"

namespace sweepscope::ui {
namespace {

TEST(ViewCamera, TheViewsAreWhereTheirNamesSay) {
  const PixelRect pane{0, 0, 400, 400};
  const auto px = [&](double turn, double elevation, const Eigen::Vector3d& p) {
    return *projection_of({{0, 0, 0}, 4, turn, elevation}, false, pane)(p);
  };
  EXPECT_NEAR(px(0, 90, {1, 0, 0}).x, 300, 1e-9) << "from above: x to the right";
  EXPECT_NEAR(px(0, 90, {0, 1, 0}).y, 100, 1e-9) << "and y up";
  EXPECT_NEAR(px(0, 0, {1, 0, 0}).x, 300, 1e-9) << "from the front: x to the right";
  EXPECT_NEAR(px(0, 0, {0, 0, 1}).y, 100, 1e-9) << "and z up";
  EXPECT_NEAR(px(90, 0, {0, 1, 0}).x, 300, 1e-9) << "from the right: y to the right";
}

TEST(ViewCamera, ZoomingKeepsThePlaceUnderTheMouse) {
  const PixelRect pane{50, 20, 640, 480};
  const ViewPoint view{{1, 2, 3}, 10, 30, 50};
  const PixelPoint mouse{200, 300};
  const Eigen::Vector3d before = place_under(mouse, view, pane);
  const Eigen::Vector3d after = place_under(mouse, zoomed(view, 1.7, mouse, pane), pane);
  EXPECT_LT((before - after).norm(), 1e-9);
}

TEST(ViewCamera, MovingTakesThePlaceAlongWithTheMouse) {
  const PixelRect pane{0, 0, 640, 480};
  const ViewPoint view{{1, 2, 3}, 10, 30, 50};
  const Eigen::Vector3d before = place_under({100, 100}, view, pane);
  const Eigen::Vector3d after = place_under({125, 90}, moved(view, 25, -10, 480), pane);
  EXPECT_LT((before - after).norm(), 1e-9);
}

}  // namespace
}  // namespace sweepscope::ui
