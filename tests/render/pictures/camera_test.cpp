#include "render/pictures/camera.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

const PixelRect kPlace{100, 50, 400, 200};

void expect_at(const Projection& projection, const Eigen::Vector3d& point_m, double x, double y) {
  const auto at = projection(point_m);
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(at->x, x, 1e-6);
  EXPECT_NEAR(at->y, y, 1e-6);
}

TEST(Projection, FromAboveXGoesRightAndYUp) {
  const Projection projection(camera_from_above({10, 20}, 20), kPlace);
  EXPECT_DOUBLE_EQ(projection.metres_per_px(), 0.1);
  expect_at(projection, {10, 20, 5}, 300, 150);
  expect_at(projection, {11, 20, -5}, 310, 150);
  expect_at(projection, {10, 21, 0}, 300, 140);
}

TEST(Projection, TurnedYGoesRightAndXDown) {
  const Projection projection(camera_from_above({10, 20}, 20, true), kPlace);
  expect_at(projection, {10, 21, 0}, 310, 150);
  expect_at(projection, {11, 20, 0}, 300, 160);
}

TEST(Projection, APointBehindAPerspectiveCameraIsNowhere) {
  Camera camera;
  camera.position_m = {0, 0, 10};
  camera.orthographic = false;
  const Projection projection(camera, kPlace);
  EXPECT_TRUE(projection({0, 0, 0}).has_value());
  EXPECT_FALSE(projection({0, 0, 11}).has_value());
}

TEST(Projection, InPerspectiveFarThingsAreSmaller) {
  Camera camera;
  camera.position_m = {0, 0, 10};
  camera.orthographic = false;
  const Projection projection(camera, kPlace);
  const double near_px = projection({1, 0, 5})->x - 300, far_px = projection({1, 0, 0})->x - 300;
  EXPECT_NEAR(near_px / far_px, 2, 1e-9);
}

class ViewpointTest : public testing::TestWithParam<std::tuple<Viewpoint, bool>> {};

TEST_P(ViewpointTest, TheWholeBoxIsInTheViewAndFillsIt) {
  const auto [from, orthographic] = GetParam();
  const Box box{{-3, 2, -1}, {9, 5, 4}};
  const Projection projection(camera_on(box, from, orthographic, kPlace.width / kPlace.height), kPlace);
  double widest = 0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1 ? box.to_m : box.from_m).x(), (i & 2 ? box.to_m : box.from_m).y(),
                                 (i & 4 ? box.to_m : box.from_m).z());
    const auto at = projection(corner);
    ASSERT_TRUE(at.has_value());
    EXPECT_TRUE(kPlace.contains(*at));
    widest = std::max({widest, std::abs(at->x - 300) / 200, std::abs(at->y - 150) / 100});
  }
  EXPECT_GT(widest, 0.7);
}

INSTANTIATE_TEST_SUITE_P(All, ViewpointTest,
                         testing::Combine(testing::Values(Viewpoint::kTop, Viewpoint::kFront,
                                                          Viewpoint::kRight, Viewpoint::kIsometric),
                                          testing::Bool()));

TEST(Viewpoint, FromTheFrontZIsUpAndXGoesRight) {
  const Box box{{0, 0, 0}, {2, 2, 2}};
  const Projection projection(camera_on(box, Viewpoint::kFront, true, 2), kPlace);
  const auto origin = *projection({0, 0, 0}), x = *projection({1, 0, 0}), z = *projection({0, 0, 1});
  EXPECT_GT(x.x, origin.x);
  EXPECT_LT(z.y, origin.y);
  EXPECT_NEAR(projection({0, 1, 0})->x, origin.x, 1e-9);
}

TEST(Viewpoint, AnUnknownOneIsAnsweredWithThoseThatThereAre) {
  EXPECT_EQ(viewpoint("left").error().message,
            "There is no viewpoint \"left\"; there are top, front, right, isometric");
}

}  // namespace
}  // namespace sweepscope
