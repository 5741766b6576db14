#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "render/clouds/points.hpp"
#include "render/images/image_difference.hpp"
#include "render/pictures/depth_cues.hpp"
#include "render/pictures/live_view.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {
namespace {

Camera from_above() {
  return camera_from_above({0, 0}, 12);
}
Camera isometric(bool orthographic = true) {
  return camera_on({{-4, -4, 0}, {4, 4, 2}}, Viewpoint::kIsometric, orthographic, 1.25);
}

/// A floor with a box on it, at so many points per square metre.
std::vector<std::array<float, 3>> box_on_floor(double per_m2) {
  std::mt19937 random(1);
  const auto within = [&](double from, double to) {
    return static_cast<float>(from + (to - from) * static_cast<double>(random() >> 8) / (1U << 24));
  };
  std::vector<std::array<float, 3>> xyz_m;
  for (int i = 0; i < static_cast<int>(64 * per_m2); ++i) xyz_m.push_back({within(-4, 4), within(-4, 4), 0});
  for (int i = 0; i < static_cast<int>(4 * per_m2); ++i) {
    xyz_m.push_back({within(-1, 1), within(-1, 1), 2});
    xyz_m.push_back({1, within(-1, 1), within(0, 2)});
    xyz_m.push_back({within(-1, 1), -1, within(0, 2)});
  }
  return xyz_m;
}

Picture picture_of(double per_m2, const Camera& camera) {
  auto points = std::make_shared<ColouredPoints>();
  for (const auto& p : box_on_floor(per_m2)) points->add(p, 0.6f);
  Picture picture{300, 240, {9, 11, 14}, {View{{0, 0, 300, 240}, {}}}, {}};
  Scene& scene = picture.views[0].scene;
  scene.clouds.push_back({points, 2});
  scene.colours = {*colour_table("grey"), 0, 1};
  scene.camera = camera;
  return picture;
}

double mean(const Image& image) {
  double sum = 0;
  for (const std::uint8_t value : image.rgba) sum += value;
  return sum / static_cast<double>(image.rgba.size());
}

/// The part of the picture that points cover.
double coverage(const Image& image) {
  double covered = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += Image::kChannels) covered += image.rgba[i] > 40 ? 1 : 0;
  return covered / (static_cast<double>(image.width_px) * image.height_px);
}

TEST(DepthCues, PlansStayFlatAndEveryOtherViewIsLit) {
  const ShownCues none, all{true, true, true, true};
  EXPECT_EQ(cues_in(from_above(), {}), none);
  EXPECT_EQ(cues_in(camera_from_above({1, 2}, 5, true), {}), none);
  EXPECT_EQ(cues_in(isometric(), {}), all);
  Camera perspective = from_above();
  perspective.orthographic = false;
  EXPECT_EQ(cues_in(perspective, {}), all);
}

TEST(DepthCues, WithoutLightingEverythingIsFlatUnlessItIsAskedFor) {
  EXPECT_EQ(cues_in(isometric(), {.lighting = Switch::kOff}), ShownCues());
  EXPECT_EQ(cues_in(isometric(), {.lighting = Switch::kOff, .grid = Switch::kOn}),
            (ShownCues{false, false, true, false}));
  EXPECT_EQ(cues_in(from_above(), {.lighting = Switch::kOn, .splats = Switch::kOff}),
            (ShownCues{true, false, true, true}));
}

TEST(Lit, APictureShadesTheEdgesOfABoxAndKeepsItsMeanBrightnessAtAnyDensity) {
  for (const double per_m2 : {20.0, 200.0, 2000.0, 20000.0}) {
    for (const bool orthographic : {true, false}) {
      Picture picture = picture_of(per_m2, isometric(orthographic));
      const Image flat = draw(picture).value();
      picture.views[0].scene.lighting = Lighting{};
      const Image lit = draw(picture).value();
      EXPECT_NEAR(mean(lit), mean(flat), 0.2 * mean(flat)) << per_m2;
      if (per_m2 >= 2000) {
        EXPECT_FALSE(compare_images(lit, flat).passes) << per_m2;
      }
    }
  }
}

TEST(Lit, APictureIsTheSameRunAfterRun) {
  Picture picture = picture_of(2000, isometric());
  picture.views[0].scene.lighting = Lighting{};
  picture.views[0].scene.clouds[0].splats = true;
  EXPECT_EQ(draw(picture).value(), draw(picture).value());
}

TEST(Splats, CloseSurfacesWherePointsAreSparseAndLeaveDensePointsAsTheyAre) {
  for (const bool orthographic : {true, false}) {
    for (const auto& [per_m2, least_growth, most_growth] :
         {std::tuple{40.0, 1.4, 9.0}, std::tuple{20000.0, 0.95, 1.06}}) {
      Picture picture = picture_of(per_m2, isometric(orthographic));
      const double before = coverage(draw(picture).value());
      picture.views[0].scene.clouds[0].splats = true;
      const double after = coverage(draw(picture).value());
      EXPECT_GT(after, least_growth * before) << per_m2;
      EXPECT_LT(after, most_growth * before) << per_m2;
    }
  }
}

TEST(Splats, SpacingIsThatOfASurfaceAtAnyDensity) {
  for (const double per_m2 : {20.0, 200.0, 2000.0, 20000.0}) {
    std::vector<float> spacing_m = spacing_of(box_on_floor(per_m2));
    std::nth_element(spacing_m.begin(), spacing_m.begin() + static_cast<std::ptrdiff_t>(spacing_m.size() / 2),
                     spacing_m.end());
    EXPECT_NEAR(spacing_m[spacing_m.size() / 2] * std::sqrt(per_m2), 1, 0.25) << per_m2;
  }
}

TEST(Splats, PointsThatAreAloneHaveNoSpacing) {
  const std::vector<std::array<float, 3>> alone{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  EXPECT_EQ(spacing_of(alone), std::vector<float>(3, 0.0f));
}

TEST(GroundGrid, LiesAtRoundMetresBelowTheBoxAndIsHiddenByPoints) {
  const Camera camera = isometric();
  const Projection projection(camera, {0, 0, 300, 240});
  const GroundGrid grid = ground_grid({{-3.7, -2.2, 0.4}, {3.1, 4.9, 2}}, projection, 25);
  EXPECT_EQ(grid.z_m, 0.4);
  EXPECT_EQ(grid.step_m, 1);
  EXPECT_EQ(grid.from_m, Eigen::Vector2d(-4, -3));
  EXPECT_EQ(grid.to_m, Eigen::Vector2d(4, 5));
  EXPECT_GE(grid.step_m / projection.metres_per_px(), 25);

  Picture picture = picture_of(30000, camera);
  const Image without = draw(picture).value();
  picture.views[0].scene.grid = ground_grid({{-6, -6, 0}, {6, 6, 2}}, projection, 25);
  picture.views[0].scene.grid->lines = picture.views[0].scene.grid->text = {255, 0, 0};
  const Image with = draw(picture).value();
  const auto red = [&](int x, int y) { return with.pixel(x, y)[0] > with.pixel(x, y)[1] + 60; };
  int beside = 0, on_points = 0;
  for (int y = 0; y < with.height_px; ++y) {
    for (int x = 0; x < with.width_px; ++x)
      (without.pixel(x, y)[0] > 60 ? on_points : beside) += red(x, y) ? 1 : 0;
  }
  EXPECT_GT(beside, 500);
  EXPECT_LT(on_points, 30);
}

TEST(GroundGrid, NoLabelLiesOnAnother) {
  for (const double turn : {0.0, 0.3, 0.6, 0.9, 1.2, 1.5}) {
    Camera camera = isometric();
    camera.position_m = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * camera.position_m;
    const Projection projection(camera, {0, 0, 300, 240});
    const GroundGrid grid = ground_grid({{-4, -4, 0}, {4, 4, 2}}, projection, 14);
    const Drawing drawing = grid_marks(grid, camera, projection);
    std::vector<PixelRect> places;
    for (const Drawing::Mark& mark : drawing.marks()) {
      const auto* label = std::get_if<TextMark>(&mark);
      if (label == nullptr) continue;
      const double width_px = text_width_px(label->text, label->size_px);
      const PixelRect place{label->at.x - width_px / 2, label->at.y - label->size_px / 2, width_px,
                            label->size_px};
      for (const PixelRect& other : places)
        EXPECT_TRUE(place.left >= other.right() || other.left >= place.right() ||
                    place.top >= other.bottom() || other.top >= place.bottom())
            << label->text << " at turn " << turn;
      places.push_back(place);
    }
    EXPECT_GT(places.size(), 6u);
  }
}

TEST(GroundGrid, IsNotSeenFromTheSideOrFromBelow) {
  Camera camera = isometric();
  const Projection projection(camera, {0, 0, 300, 240});
  const GroundGrid grid = ground_grid({{-4, -4, 0}, {4, 4, 2}}, projection, 25);
  EXPECT_FALSE(grid_marks(grid, camera, projection).marks().empty());
  camera.position_m.z() *= -1;
  EXPECT_TRUE(grid_marks(grid, camera, Projection(camera, {0, 0, 300, 240})).marks().empty());
}

TEST(ScannerMark, IsHalfADiscOfItsSizeInTheScanningPlane) {
  const Camera camera = from_above();
  const Projection projection(camera, {0, 0, 300, 240});
  const Drawing level = scanner_marks({{{1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, 30, {}}, projection);
  const auto& disc = std::get<PolygonMark>(level.marks().front());
  const PixelPoint centre = *projection({1, 1, 0});
  for (const PixelPoint& point : disc.points) {
    EXPECT_NEAR(std::hypot(point.x - centre.x, point.y - centre.y), 30, 1e-6);
    EXPECT_GE(point.x, centre.x - 1e-6);  // forward is x
  }
  // On its side it is a line from above.
  const Drawing upright = scanner_marks({{{1, 1, 0}, {1, 0, 0}, {0, 0, 1}}, 30, {}}, projection);
  for (const PixelPoint& point : std::get<PolygonMark>(upright.marks().front()).points)
    EXPECT_NEAR(point.y, centre.y, 1e-6);
}

class LitLive : public testing::Test {
 protected:
  void SetUp() override {
    view_.resize(300, 240);
    view_.set_background({9, 11, 14});
    view_.set_point_size(2);
    auto points = std::make_shared<LivePoints>();
    points->xyz_m = box_on_floor(3000);
    points->rgb.assign(points->size(), {150, 150, 150});
    points->spacing_m = spacing_of(points->xyz_m);
    points_ = points;
    view_.set_camera(isometric());
    view_.show(points_, points_);
  }
  Image drawn() {
    view_.draw(60);
    return view_.picture(LiveView::Points::kAll);
  }

  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(64, 64);
  LiveView view_{*context_};
  LivePointsPtr points_;
};

TEST_F(LitLive, IsLitWhileItMovesAndAtRestAndFlatAgainAfterwards) {
  const Image flat = drawn();
  view_.set_lighting(Lighting{});
  EXPECT_FALSE(view_.has_all_points());
  const Image lit = drawn();
  EXPECT_FALSE(compare_images(lit, flat).passes);
  EXPECT_NEAR(mean(lit), mean(flat), 0.2 * mean(flat));
  view_.set_moving(true);
  view_.set_camera(isometric(false));
  view_.set_camera(isometric());
  EXPECT_EQ(drawn(), lit);  // the coarse points are the same ones here
  view_.set_moving(false);
  view_.set_lighting(std::nullopt);
  EXPECT_EQ(drawn(), flat);
}

TEST_F(LitLive, SlicesAndOnePieceGiveTheSameLitPicture) {
  view_.set_lighting(Lighting{});
  view_.set_splats(true);
  const Image at_once = drawn();
  view_.set_splats(false);
  view_.set_splats(true);
  while (!view_.done()) view_.draw(0);
  EXPECT_EQ(view_.picture(LiveView::Points::kAll), at_once);
}

}  // namespace
}  // namespace sweepscope
