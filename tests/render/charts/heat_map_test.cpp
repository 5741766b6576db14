#include "render/charts/heat_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sweepscope {
namespace {

HeatMap two_by_two() {
  HeatMap map;
  map.title = "values";
  map.x = {0, 2};
  map.y = {0, 2};
  map.columns = map.rows = 2;
  map.values = {-1, 0, std::numeric_limits<double>::quiet_NaN(), 1};
  map.colours = {diverging_table(), -1, 1};
  return map;
}

// The middle of a filled shape of this colour, if there is exactly one.
std::optional<PixelPoint> place_of(const Drawing& drawing, Colour colour) {
  std::optional<PixelPoint> place;
  for (const auto& mark : drawing.marks()) {
    const auto* polygon = std::get_if<PolygonMark>(&mark);
    if (polygon == nullptr || !(polygon->colour == colour)) continue;
    if (place) return std::nullopt;
    place = PixelPoint{(polygon->points[0].x + polygon->points[2].x) / 2,
                       (polygon->points[0].y + polygon->points[2].y) / 2};
  }
  return place;
}

TEST(HeatMap, EachValueIsACellAtItsPlaceAndWhatHasNoneIsLeftOut) {
  const HeatMap map = two_by_two();
  Drawing drawing;
  add_heat_map(drawing, {0, 0, 300, 300}, map, style_of(Background::kWhite), 1);
  const auto least = place_of(drawing, map.colours.at(-1)), zero = place_of(drawing, map.colours.at(0)),
             greatest = place_of(drawing, map.colours.at(1));
  ASSERT_TRUE(least && zero && greatest);
  EXPECT_LT(least->x, zero->x);
  EXPECT_EQ(least->y, zero->y);
  EXPECT_EQ(greatest->x, zero->x);
  EXPECT_LT(greatest->y, zero->y) << "the greatest y is at the top";
  EXPECT_FALSE(place_of(drawing, map.colours.no_value));
}

TEST(HeatMap, TheBarsTopIsTheGreatestValue) {
  const HeatMap map = two_by_two();
  Drawing drawing;
  add_colour_bar(drawing, {10, 10, 20, 256}, map.colours, "[mm]", style_of(Background::kWhite), 1);
  double top = 1e9, bottom = -1e9;
  Colour at_top, at_bottom;
  for (const auto& mark : drawing.marks()) {
    const auto* polygon = std::get_if<PolygonMark>(&mark);
    if (polygon == nullptr || polygon->points[2].x - polygon->points[0].x < 19) continue;
    if (polygon->colour == style_of(Background::kWhite).frame) continue;
    if (polygon->points[0].y < top) top = polygon->points[0].y, at_top = polygon->colour;
    if (polygon->points[2].y > bottom) bottom = polygon->points[2].y, at_bottom = polygon->colour;
  }
  EXPECT_GT(at_top.red, at_top.blue) << "orange";
  EXPECT_GT(at_bottom.blue, at_bottom.red) << "violet";
}

TEST(DivergingTable, IsNearlyWhiteInTheMiddleAndTellsItsSidesApartByBlueAndNotByGreen) {
  const ColourTable table = diverging_table();
  for (const std::size_t i : {127U, 128U}) EXPECT_GT(std::min(table[i].red, table[i].green), 240) << i;
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_GT(table[i].blue, table[i].red) << i;
    EXPECT_LT(table[255 - i].blue, table[255 - i].red) << i;
    EXPECT_LT(std::abs(table[i].green - table[255 - i].green), 75) << i;
  }
}

}  // namespace
}  // namespace sweepscope
