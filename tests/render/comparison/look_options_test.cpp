#include "render/comparison/look_options.hpp"

#include <gtest/gtest.h>

#include <set>

namespace sweepscope {
namespace {

Result<ComparisonOptions> looked(const std::string& name, const std::string& text) {
  ComparisonOptions options;
  return set_look(options, *find_look_option(name), text).map([&] { return options; });
}

TEST(LookOptions, EachSetsWhatItSays) {
  EXPECT_EQ(looked("size", "800x600")->height_px, 600);
  EXPECT_EQ(looked("background", "white")->background, Background::kWhite);
  EXPECT_EQ(looked("colour-by", "blur")->colour_by, ColourBy::kBlur);
  EXPECT_EQ(looked("colour-table", "turbo")->colour_table, "turbo");
  EXPECT_EQ(looked("colour-range", "-1:40")->colour_range->to, 40);
  EXPECT_EQ(looked("point-size", "2.5")->point_size_px, 2.5);
  EXPECT_EQ(looked("viewpoint", "isometric")->viewpoint, Viewpoint::kIsometric);
  EXPECT_TRUE(looked("perspective", "true")->perspective);
  EXPECT_EQ(looked("box", "0:1:2:3:4:5")->box->to_m, Eigen::Vector3d(3, 4, 5));
  EXPECT_EQ(looked("slab", "0.8:3")->slabs.at(0).to_m, 3);
  EXPECT_EQ(looked("close-up", "1:2:3")->close_up->height_m, 3);
  EXPECT_FALSE(looked("close-up", "none")->with_close_up);
  EXPECT_EQ(looked("title", "A title")->title, "A title");
}

TEST(LookOptions, AnExplicitCameraShowsTheExtentWhereItLooks) {
  const Camera camera = *looked("camera", "0:-10:0:0:0:0:4")->camera;
  const PixelRect place{0, 0, 200, 100};
  for (const bool orthographic : {true, false}) {
    Camera one = camera;
    one.orthographic = orthographic;
    const auto top = Projection(one, place)({0, 0, 2});
    ASSERT_TRUE(top.has_value());
    EXPECT_NEAR(top->y, 0, 1e-9) << "2 m up is the upper edge of a view of 4 m";
  }
}

TEST(LookOptions, NonsenseIsRefusedWithTheOptionsName) {
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"size", "800"},        {"size", "0x600"},       {"size", "800x600x1"},       {"background", "pink"},
      {"colour-by", "smell"}, {"colour-range", "3:1"}, {"point-size", "0"},         {"viewpoint", "below"},
      {"perspective", "yes"}, {"camera", "1:2:3"},     {"camera", "0:0:0:0:0:0:1"}, {"box", "0:0:0:0:1:1"},
      {"slab", "3:0.8"},      {"slab", "nan:1"},       {"close-up", "1:2"},         {"colour-table", "jet"}};
  for (const auto& [name, text] : wrong) {
    const auto set = looked(name, text);
    ASSERT_FALSE(set) << name << " " << text;
    EXPECT_EQ(set.error().code, ExitCode::kWrongUsage);
    EXPECT_EQ(set.error().message.find(std::string(name) + " " + text + ": "), 0U) << set.error().message;
  }
}

TEST(LookOptions, HaveNamesOfTheirOwnAndHelp) {
  std::set<std::string> names;
  for (const LookOption& option : look_options()) {
    EXPECT_TRUE(names.insert(option.name).second) << option.name;
    EXPECT_FALSE(option.help.empty()) << option.name;
  }
  EXPECT_EQ(find_look_option("no-such-option"), nullptr);
}

}  // namespace
}  // namespace sweepscope
