#include <gtest/gtest.h>

#include <vector>

#include "render/pictures/picture.hpp"

namespace sweepscope {
namespace {

/// The lines that a path makes in a view of 100 x 100 pixels at (20, 10) that shows 10 m x 10 m about the
/// origin.
std::vector<std::vector<PixelPoint>> lines_of(std::vector<Eigen::Vector3d> points_m) {
  Picture picture;
  View& view = picture.views.emplace_back();
  view.place = {20, 10, 100, 100};
  view.scene.camera = camera_from_above({0, 0}, 10);
  view.scene.paths.push_back({std::move(points_m), 1, {}});
  std::vector<std::vector<PixelPoint>> lines;
  const Drawing flat = flat_marks(picture);
  for (const Drawing::Mark& mark : flat.marks()) lines.push_back(std::get<LineMark>(mark).points);
  return lines;
}

void expect_line(const std::vector<PixelPoint>& line, const std::vector<PixelPoint>& expected) {
  ASSERT_EQ(line.size(), expected.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i].x, expected[i].x, 1e-9) << i;
    EXPECT_NEAR(line[i].y, expected[i].y, 1e-9) << i;
  }
}

TEST(SceneMarks, AFrameThatReachesBeyondItsViewIsDrawnUpToTheBorder) {
  // Its lower side, at y = -6, lies outside.
  const auto lines = lines_of({{-2, -6, 0}, {2, -6, 0}, {2, 1, 0}, {-2, 1, 0}, {-2, -6, 0}});
  ASSERT_EQ(lines.size(), 1U);
  expect_line(lines[0], {{90, 110}, {90, 50}, {50, 50}, {50, 110}});
}

TEST(SceneMarks, APathThatLeavesItsViewAndComesBackIsTwoLines) {
  const auto lines = lines_of({{0, 0, 0}, {8, 0, 0}, {8, 4, 0}, {0, 4, 0}});
  ASSERT_EQ(lines.size(), 2U);
  expect_line(lines[0], {{70, 60}, {120, 60}});
  expect_line(lines[1], {{120, 20}, {70, 20}});
}

TEST(SceneMarks, ALineBetweenPlacesOutsideIsDrawnWhereItCrossesTheView) {
  const auto lines = lines_of({{-7, 0, 0}, {7, 0, 0}, {7, 9, 0}});
  ASSERT_EQ(lines.size(), 1U);
  expect_line(lines[0], {{20, 60}, {120, 60}});
}

TEST(SceneMarks, PointsLessThanTwoPixelsApartAreLeftOut) {
  const auto lines = lines_of({{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {1, 0, 0}});
  ASSERT_EQ(lines.size(), 1U);
  expect_line(lines[0], {{70, 60}, {72, 60}, {80, 60}});
}

}  // namespace
}  // namespace sweepscope
