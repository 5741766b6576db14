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

/// Where the corners of a box are in a picture, as fractions of its width and height.
std::pair<Eigen::Array2d, Eigen::Array2d> extent_of(const Box& box, const ViewPoint& view, double aspect,
                                                    bool perspective) {
  const Projection projection = projection_of(view, perspective, {0, 0, aspect, 1});
  Eigen::Array2d from(1e9, 1e9), to(-1e9, -1e9);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p{((corner & 1) != 0 ? box.to_m : box.from_m).x(),
                            ((corner & 2) != 0 ? box.to_m : box.from_m).y(),
                            ((corner & 4) != 0 ? box.to_m : box.from_m).z()};
    const PixelPoint at = *projection(p);
    from = from.min(Eigen::Array2d(at.x / aspect, at.y));
    to = to.max(Eigen::Array2d(at.x / aspect, at.y));
  }
  return {from, to};
}

TEST(ViewCamera, AFittedViewShowsAllOfTheBoxAboveOrBesideWhatIsCovered) {
  const Box wide{{-30, -5, 0}, {30, 9, 4}}, high{{2, -40, 0}, {8, 40, 4}};
  for (const bool perspective : {false, true}) {
    for (const double aspect : {0.6, 1.0, 2.5}) {
      for (const double elevation_deg : {90.0, 35.0}) {
        for (const Box& box : {wide, high}) {
          // Above or beside what is covered where the scale is the same everywhere; in perspective nothing is
          // cut.
          const PictureShape shape =
              perspective ? PictureShape{aspect, 0, 0} : PictureShape{aspect, 0.4, 0.3};
          const ViewPoint view = fitted({{0, 0, 0}, 1, 20, elevation_deg}, box, shape, perspective);
          const auto [from, to] = extent_of(box, view, aspect, perspective);
          EXPECT_GE(from.minCoeff(), 0);
          EXPECT_LE(to.maxCoeff(), 1);
          EXPECT_TRUE(perspective || to.x() <= 0.6 || to.y() <= 0.7) << to.transpose();
        }
      }
    }
  }
}

}  // namespace
}  // namespace sweepscope::ui
