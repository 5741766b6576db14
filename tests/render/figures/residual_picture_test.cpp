#include "render/figures/residual_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

ResidualGrid grid_of(double residual_m) {
  ResidualGrid grid;
  grid.motor = grid.beam = {-1, 1};
  grid.columns = grid.rows = 10;
  grid.residual_m.assign(100, residual_m);
  return grid;
}

const TextMark* text_with(const Drawing& drawing, const std::string& part) {
  for (const auto& mark : drawing.marks())
    if (const auto* text = std::get_if<TextMark>(&mark);
        text != nullptr && text->text.find(part) != part.npos)
      return text;
  return nullptr;
}

Picture picture_of(int width_px, int height_px) {
  ComparisonOptions look;
  look.width_px = width_px;
  look.height_px = height_px;
  return residual_picture({grid_of(0.02), grid_of(-0.001)}, look);
}

TEST(ResidualPicture, BothMapsHaveOneSymmetricRange) {
  RigResiduals residuals{grid_of(0.0123), grid_of(0.001)};
  EXPECT_NEAR(residual_range_mm(residuals), 13, 1e-9);
  residuals.before.residual_m[0] = 5;  // a person
  EXPECT_NEAR(residual_range_mm(residuals), 13, 1e-9);
  EXPECT_EQ(residual_range_mm({grid_of(1e-5), grid_of(0)}), 1) << "not the noise";
}

TEST(ResidualPicture, AWideOneHasBeforeAndAfterBesideEachOtherAndAHighOneBelow) {
  const Picture wide = picture_of(1000, 500), high = picture_of(460, 800);
  const auto places = [](const Picture& picture) {
    return std::pair(text_with(picture.marks, "With the rig file: 20.00 mm rms")->at,
                     text_with(picture.marks, "With the rig found: 1.00 mm rms")->at);
  };
  EXPECT_EQ(places(wide).first.y, places(wide).second.y);
  EXPECT_LT(places(wide).first.x, places(wide).second.x);
  EXPECT_EQ(places(high).first.x, places(high).second.x);
  EXPECT_LT(places(high).first.y, places(high).second.y);
}

}  // namespace
}  // namespace sweepscope
