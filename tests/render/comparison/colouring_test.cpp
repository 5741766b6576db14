#include "render/comparison/colouring.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sweepscope {
namespace {

ComparedMap two_points() {
  MapCloud::Ptr cloud(new MapCloud);
  for (int i = 0; i < 2; ++i) {
    MapPoint point{};
    point.x = static_cast<float>(i);
    point.z = 2.5F + static_cast<float>(i);
    point.intensity = 7;
    point.sweep = static_cast<std::uint32_t>(3 + i);
    point.time_s = 10 + i;
    cloud->push_back(point);
  }
  ComparedMap map;
  map.cloud = cloud;
  return map;
}

TEST(Colouring, ValuesAreThoseOfThePointsInTheUnitOfTheLegend) {
  const ComparedMap map = two_points();
  EXPECT_EQ(*colour_values(map, nullptr, ColourBy::kElevation), (std::vector<float>{2.5F, 3.5F}));
  EXPECT_EQ(*colour_values(map, nullptr, ColourBy::kIntensity), (std::vector<float>{7, 7}));
  EXPECT_EQ(*colour_values(map, nullptr, ColourBy::kTime), (std::vector<float>{0, 1}));
  EXPECT_EQ(*colour_values(map, nullptr, ColourBy::kDirection), (std::vector<float>{1, 0}));
}

TEST(Colouring, DistancesAreMillimetresToTheOtherMap) {
  const ComparedMap a = two_points();
  ComparedMap b = two_points();
  MapCloud::Ptr moved(new MapCloud(*b.cloud));
  for (MapPoint& point : *moved) point.y += 0.05F;
  b.cloud = moved;
  const std::vector<float> values = *colour_values(a, &b, ColourBy::kDistance);
  for (const float value : values) EXPECT_NEAR(value, 50, 0.01);
}

TEST(Colouring, WhatAMapCannotTellIsRefusedInASentence) {
  const ComparedMap map = two_points();
  EXPECT_EQ(colour_values(map, nullptr, ColourBy::kDistance).error().code, ExitCode::kWrongUsage);
  EXPECT_NE(colour_values(map, nullptr, ColourBy::kFeatures).error().message.find("needs a recording"),
            std::string::npos);
}

TEST(Colouring, OneRangeHoldsForAllMapsWithoutTheOutermostValues) {
  std::vector<float> low(1000), high(1000);
  for (int i = 0; i < 1000; ++i) low[i] = static_cast<float>(i) * 1e-3F, high[i] = 1 + low[i];
  high[999] = 1e6F;
  high[998] = NAN;
  const std::vector<std::span<const float>> both{low, high};
  const Colouring colouring = *make_colouring(ColourBy::kElevation, "viridis", both, std::nullopt);
  EXPECT_NEAR(colouring.scale.from, 0.01, 0.005);
  EXPECT_NEAR(colouring.scale.to, 1.99, 0.01);
  EXPECT_EQ(make_colouring(ColourBy::kElevation, "viridis", both, ValueRange{3, 4})->scale.from, 3);
}

TEST(Colouring, LengthsBeginAtNothing) {
  const std::vector<float> thick(100, 35.0F);
  const std::vector<std::span<const float>> one{thick};
  const Colouring colouring = *make_colouring(ColourBy::kBlur, "viridis", one, std::nullopt);
  EXPECT_EQ(colouring.scale.from, 0);
  EXPECT_NEAR(colouring.scale.to, 35, 1e-6);
  EXPECT_EQ(colouring.unit, "mm");
}

TEST(Colouring, ClassesAreListedWhereTheyOccurAndKeepTheirColours) {
  const std::vector<float> kinds{1, 2, 2};
  const std::vector<std::span<const float>> one{kinds};
  const Colouring colouring = *make_colouring(ColourBy::kFeatures, "viridis", one, std::nullopt);
  ASSERT_EQ(colouring.classes.size(), 2U);
  EXPECT_EQ(colouring.classes[0].name, "edge");
  EXPECT_EQ(colouring.scale.at(1), colouring.classes[0].colour);
  EXPECT_EQ(colouring.scale.at(2), colouring.classes[1].colour);
}

TEST(Colouring, NoValueHasAColourOfItsOwn) {
  const ColourScale scale{*colour_table("viridis"), 0, 1};
  EXPECT_EQ(scale.at(NAN), scale.no_value);
}

}  // namespace
}  // namespace sweepscope
