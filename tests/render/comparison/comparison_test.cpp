#include "render/comparison/comparison.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "core/map/consistency/map_consistency.hpp"
#include "render/comparison/comparison_json.hpp"
#include "render/comparison/comparison_layout.hpp"
#include "render/comparison/comparison_points.hpp"
#include "render/gl/context.hpp"
#include "render/images/image_difference.hpp"
#include "tests/folder_test.hpp"
#include "tests/render/synthetic_maps.hpp"

namespace sweepscope {
namespace {

constexpr double kRollError_rad = 0.0314;  // 5 ms of a motor that makes a half turn in 0.5 s

std::vector<ComparedMap> hall_maps(std::size_t points = 60'000) {
  std::vector<ComparedMap> maps(2);
  maps[0].offset_s = 0.019;
  maps[0].cloud = test::HallMap(kRollError_rad, points).make();
  maps[1].offset_s = 0.024;
  maps[1].cloud = test::HallMap(0, points).make();
  return maps;
}

ComparisonOptions small_options() {
  ComparisonOptions options;
  options.width_px = 960;
  options.height_px = 600;
  return options;
}

Image drawn(const std::vector<ComparedMap>& maps, const ComparisonOptions& options,
            const Estimate* estimate) {
  const auto image = comparison_picture(maps, estimate, options).and_then(draw);
  EXPECT_TRUE(image.has_value());
  return image.value_or(Image());
}

std::vector<float> heights_of(const ComparedMap& map) {
  return *colour_values(map, nullptr, ColourBy::kElevation);
}

TEST(OffscreenContext, IsDrawnByLlvmpipe) {
  const auto context = gl::make_offscreen_context(16, 16);
  ASSERT_TRUE(context) << context.error().message;
  (*context)->make_current();
  EXPECT_TRUE((*context)->is_current());
  EXPECT_EQ((*context)->renderer().substr(0, 8), "llvmpipe");
  (*context)->release();
  EXPECT_FALSE((*context)->is_current());
}

TEST(OffscreenContext, OneIsCurrentAtATime) {
  const auto first = gl::make_offscreen_context(16, 16), second = gl::make_offscreen_context(16, 16);
  (*first)->make_current();
  (*second)->make_current();
  EXPECT_FALSE((*first)->is_current());
  EXPECT_TRUE((*second)->is_current());
}

TEST(Comparison, IsTheSameToTheBitEachTime) {
  const auto maps = hall_maps();
  const Estimate curve = test::stationary_curve();
  const Image first = drawn(maps, small_options(), &curve);
  EXPECT_EQ(first.width_px, 960);
  EXPECT_EQ(first, drawn(maps, small_options(), &curve));
}

TEST(Comparison, TheGatePassesItselfAndFailsEveryControl) {
  auto maps = hall_maps();
  const Estimate curve = test::stationary_curve();
  ComparisonOptions options = small_options();
  options.close_up = Region{{0, 0}, 4};
  const Image expected = drawn(maps, options, &curve);
  EXPECT_TRUE(compare_images(expected, expected).passes);

  Image shifted = expected;  // the left map by 3 pixels
  const PixelRect place = lay_out(options, 2, 2).overviews[0].inset(4);
  for (int y = static_cast<int>(place.top); y < place.bottom(); ++y) {
    for (int x = static_cast<int>(place.left); x < place.right(); ++x) {
      std::copy_n(expected.pixel(x - 3, y), Image::kChannels, shifted.pixel(x, y));
    }
  }
  EXPECT_FALSE(compare_images(shifted, expected).passes);

  options.title = " ";
  EXPECT_FALSE(compare_images(drawn(maps, options, &curve), expected).passes) << "a missing title";
  options.title.clear();
  maps[0].label = " ";
  EXPECT_FALSE(compare_images(drawn(maps, options, &curve), expected).passes) << "a missing label";
  maps[0].label.clear();
  options.colour_table = "cividis";
  EXPECT_FALSE(compare_images(drawn(maps, options, &curve), expected).passes) << "another colour table";
}

TEST(Comparison, EmptyMapsAndAnEmptyCurveStillMakeAPicture) {
  Estimate refused;
  refused.refusals = {{RefusalKind::kUnknown, {}, {}, "The motor does not move."}};
  std::vector<ComparedMap> maps(2);
  maps[1].cloud.reset(new MapCloud);
  const Image with_words = drawn(maps, small_options(), &refused);
  const Image without_reason = drawn(maps, small_options(), nullptr);
  EXPECT_FALSE(compare_images(with_words, without_reason).passes);
}

TEST(Comparison, TakesOneToFourMapsAndRefusesMore) {
  const auto two = hall_maps(5'000);
  for (std::size_t count = 1; count <= 4; ++count) {
    std::vector<ComparedMap> maps;
    for (std::size_t m = 0; m < count; ++m) maps.push_back(two[m % 2]);
    EXPECT_TRUE(comparison_picture(maps, nullptr, small_options())) << count;
  }
  EXPECT_FALSE(comparison_picture(std::vector<ComparedMap>(5), nullptr, small_options()));
  EXPECT_FALSE(comparison_picture({}, nullptr, small_options()));
}

TEST(ComparisonSlabs, ByDefaultTheCeilingIsCutAwayAndTheBlindMiddleToo) {
  const auto maps = hall_maps();  // floor at -1.3 m, ceiling at 3.7 m
  const auto slabs = choose_slabs(maps, {});
  ASSERT_EQ(slabs.size(), 2U);
  EXPECT_EQ(slabs[0].to_m, -0.8);
  EXPECT_EQ(slabs[1].from_m, 0.8);
  EXPECT_NEAR(slabs[1].to_m, 2.8, 0.15);  // a quarter of the way to the ceiling is left out
  for (const auto& point : points_in_slabs(maps[1], heights_of(maps[1]), slabs).points.xyz_m) {
    EXPECT_LT(point[2], 3.0);
    EXPECT_GT(std::abs(point[2]), 0.79);
  }
}

TEST(ComparisonSlabs, HeightsFollowThePathOfTheSensor) {
  ComparedMap map;
  MapCloud::Ptr cloud(new MapCloud);
  for (int i = 0; i <= 10; ++i) {  // a sensor that climbs 1 m/s and always sees 1 m above itself
    MapPoint point;
    point.x = point.y = 0;
    point.z = static_cast<float>(i + 1);
    point.time_s = i;
    cloud->push_back(point);
  }
  map.cloud = cloud;
  map.path = {{0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
              {10, {0, 0, 10}, Eigen::Quaterniond::Identity()}};
  const std::vector<HeightRange> slab{{0.9, 1.1}};
  EXPECT_EQ(points_in_slabs(map, heights_of(map), slab).points.size(), 11U);
  map.path.clear();
  EXPECT_EQ(points_in_slabs(map, heights_of(map), slab).points.size(), 1U);
}

TEST(Comparison, ABoxLeavesOutWhatIsOutside) {
  const auto maps = hall_maps(5'000);
  const Box box{{-2, -2, -1}, {2, 2, 3}};
  const std::vector<HeightRange> all{{-100, 100}};
  const auto points = points_in_slabs(maps[0], heights_of(maps[0]), all, box).points;
  ASSERT_GT(points.size(), 0U);
  for (const auto& point : points.xyz_m) {
    EXPECT_LE(std::abs(point[0]), 2);
    EXPECT_LE(std::abs(point[1]), 2);
  }
}

TEST(Comparison, AWhiteBackgroundIsOpaqueAndATransparentOneIsNot) {
  const auto maps = hall_maps(5'000);
  ComparisonOptions options = small_options();
  options.background = Background::kWhite;
  const Image white = drawn(maps, options, nullptr);
  EXPECT_TRUE(white.opaque());
  EXPECT_EQ(white.pixel(2, 2)[0], 255);
  options.background = Background::kTransparent;
  const Image transparent = drawn(maps, options, nullptr);
  EXPECT_EQ(transparent.pixel(2, 2)[3], 0);
  EXPECT_FALSE(transparent.opaque());
}

TEST(Comparison, EveryViewpointAndColouringDrawsAnotherPicture) {
  const auto maps = hall_maps(20'000);
  std::vector<Image> seen;
  const auto expect_new = [&](const ComparisonOptions& options) {
    Image image = drawn(maps, options, nullptr);
    for (const Image& other : seen) EXPECT_FALSE(compare_images(image, other).passes);
    seen.push_back(std::move(image));
  };
  for (const Viewpoint from :
       {Viewpoint::kTop, Viewpoint::kFront, Viewpoint::kRight, Viewpoint::kIsometric}) {
    ComparisonOptions options = small_options();
    options.viewpoint = from;
    expect_new(options);
    options.perspective = true;
    expect_new(options);
  }
  for (const ColourBy by : {ColourBy::kTime, ColourBy::kDirection, ColourBy::kBlur, ColourBy::kDistance}) {
    ComparisonOptions options = small_options();
    options.colour_by = by;
    expect_new(options);
  }
}

TEST(CloseUp, FindsThePillarByItself) {
  const auto maps = hall_maps(300'000);
  std::vector<SlabPoints> points;
  for (const auto& map : maps)
    points.push_back(points_in_slabs(map, heights_of(map), choose_slabs(maps, {})));
  const Region region = find_close_up(points, 4, 8);
  EXPECT_NEAR(region.centre_m.x(), 0, 0.5);
  EXPECT_NEAR(region.centre_m.y(), 0, 0.5);
}

TEST(CloseUp, OfNothingIsInTheMiddleOfNothing) {
  const std::vector<SlabPoints> nothing(2);
  EXPECT_EQ(find_close_up(nothing, 4, 8).height_m, 4);
}

TEST(Places, AreThoseWhereTheMapsDifferMostBestFirstAndEachOnce) {
  const auto maps = hall_maps(300'000);
  std::vector<SlabPoints> points;
  for (const auto& map : maps)
    points.push_back(points_in_slabs(map, heights_of(map), choose_slabs(maps, {})));
  const auto places = differing_places(points, 4, 8, 12);
  ASSERT_GT(places.size(), 2u);
  EXPECT_LE(places.size(), 12u);
  const DifferingPlace& best = places.front();
  EXPECT_EQ(best.region.centre_m, find_close_up(points, 4, 8).centre_m);
  EXPECT_LT(best.region.centre_m.norm(), 0.7);  // the pillar
  EXPECT_EQ(best.most_blurred(), 0u);
  EXPECT_EQ(best.sharpest(), 1u);
  EXPECT_GT(best.ratio(), 1.2);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((places[i].region.centre_m - places[j].region.centre_m).cwiseAbs().maxCoeff(), 8);
  }
  EXPECT_EQ(differing_places(points, 4, 8, 2).size(), 2u);
}

TEST(Places, OfAComparisonAreThoseOfItsCloseUps) {
  const auto maps = hall_maps(300'000);
  const auto places = differing_places(maps, nullptr, small_options());
  ASSERT_TRUE(places) << places.error().message;
  ASSERT_FALSE(places->empty());
  const Picture picture = *comparison_picture(maps, nullptr, small_options());
  const Eigen::Vector2d centre_m = places->front().region.centre_m;
  EXPECT_TRUE(std::any_of(picture.views.begin(), picture.views.end(), [&](const View& view) {
    return (view.scene.camera.looks_at_m.head<2>() - centre_m).norm() < 1e-9;
  }));
}

TEST(Places, OfEqualMapsOrOneMapAreNone) {
  const auto maps = hall_maps(50'000);
  const std::vector<ComparedMap> twice{maps[1], maps[1]};
  EXPECT_TRUE(differing_places(twice, nullptr, small_options())->empty());
  EXPECT_TRUE(differing_places(std::span(maps).first(1), nullptr, small_options())->empty());
}

TEST(Places, AreWrittenAsJsonWithTheMapsThatTheyCompare) {
  std::vector<ComparedMap> maps(2);
  maps[0].offset_s = 0.019;
  maps[1].label = "B";
  const std::vector<DifferingPlace> places{{{{1.25, -2}, 4}, {90, 60}}};
  EXPECT_EQ(nlohmann::json::parse(comparison_json(maps, places)), nlohmann::json::parse(R"({
      "schema": "sweepscope.compare/1",
      "map_consistency": null,
      "maps": [{"label": "", "offset_ms": 19.0, "thickness": null},
               {"label": "B", "offset_ms": null, "thickness": null}],
      "places": [{"x_m": 1.25, "y_m": -2.0, "height_m": 4.0, "cells": [90, 60],
                  "sharpest": 1, "most_blurred": 0, "ratio": 1.5}]})"));
}

MapConsistency broken_map() {
  MapConsistency broken;
  broken.limit_m = 0.3;
  broken.apart = {{12, 31.5, 0.84, {1, 2, 0.5}}};
  broken.doubt = 2.8;
  broken.warnings = {"The map does not agree with itself: surfaces lie 0.8 m apart."};
  return broken;
}

TEST(BrokenMaps, AreWrittenInTheJsonOfAComparison) {
  std::vector<ComparedMap> maps(2);
  maps[0].consistency = maps[1].consistency = std::make_shared<const MapConsistency>(broken_map());
  const auto json = nlohmann::json::parse(comparison_json(maps, {}))["map_consistency"];
  EXPECT_EQ(json["worst_m"], 0.84);
  EXPECT_EQ(json["at_s"], nlohmann::json({12.0, 31.5}));
  EXPECT_EQ(json["warned"], true);
  EXPECT_EQ(json["warnings"], nlohmann::json({broken_map().warnings.front()}));
}

TEST(BrokenMaps, AreNamedBesideTheThicknessOfTheirSurfaces) {
  ComparedMap map;
  map.consistency = std::make_shared<const MapConsistency>(broken_map());
  EXPECT_NE(in_words(map).find("; the map does not agree with itself: surfaces seen twice lie 0.8 m apart"),
            std::string::npos)
      << in_words(map);
  MapConsistency drifting;
  drifting.warnings = {"nothing in view shows how far the rig moved"};
  map.consistency = std::make_shared<const MapConsistency>(drifting);
  EXPECT_EQ(in_words(map).find("does not agree"), std::string::npos) << in_words(map);
}

using PngTest = test::FolderTest;

TEST_F(PngTest, ReadsBackWhatItWroteWithItsTexts) {
  Image image(70, 64);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = static_cast<std::uint8_t>(i * 7 % 251);
  const std::vector<PngText> texts{{"Software", "sweepscope"}, {"Maps", "θ"}};
  ASSERT_TRUE(write_png(image, folder_ / "a.png", texts));
  const auto read = read_png(folder_ / "a.png");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, image);
  EXPECT_EQ(encode_png(image, texts), test::contents_of(folder_ / "a.png"));
}

TEST_F(PngTest, BrokenFilesAreRefusedInASentence) {
  std::ofstream(folder_ / "a.png") << "not a picture";
  EXPECT_NE(read_png(folder_ / "a.png").error().message.find("not a PNG image"), std::string::npos);
  const std::string whole = encode_png(Image(64, 64));
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    std::ofstream(folder_ / "a.png", std::ios::binary) << whole.substr(0, length);
    (void)read_png(folder_ / "a.png");
  }
}

}  // namespace
}  // namespace sweepscope
