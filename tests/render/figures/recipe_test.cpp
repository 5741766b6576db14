#include "render/figures/recipe.hpp"

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

class RecipeTest : public test::FolderTest {
 protected:
  Result<Recipe> read(const std::string& text) {
    std::ofstream(folder_ / "recipe.yaml") << text;
    return read_recipe(folder_ / "recipe.yaml");
  }
  /// What is said of a wrong recipe, from the line on.
  std::string refusal(const std::string& text) {
    const auto recipe = read(text);
    if (recipe) return "accepted";
    EXPECT_EQ(recipe.error().code, ExitCode::kUnreadableInput);
    const std::string file = (folder_ / "recipe.yaml").string() + ":";
    EXPECT_EQ(recipe.error().message.substr(0, file.size()), file);
    return recipe.error().message.substr(file.size());
  }
};

const std::string kData =
    "recordings: {room: {simulate: room-1, offset_ms: 7}}\n"
    "estimates: {room: {recording: room, ranges_ms: [[5, 9, 1], [6, 8, 0.1]]}}\n";

TEST_F(RecipeTest, ReadsRecordingsEstimatesFiguresAndTables) {
  const auto recipe =
      read(kData +
           "look: {background: white}\n"
           "figures:\n"
           "  a: {kind: curves, estimates: room, criteria: [d, roll], formats: [png, pdf]}\n"
           "  b: {kind: maps, maps: [{recording: room, offset_ms: 7, poses: truth}], colour-by: blur}\n"
           "  c: {kind: profile, maps: {recording: room, offset_ms: 7}}\n"
           "  d: {kind: scan, recording: room, at_s: 1.5}\n"
           "tables:\n"
           "  t: {estimates: [room], columns: [{title: x, value: truth, decimals: 1}]}\n");
  ASSERT_TRUE(recipe) << recipe.error().message;
  EXPECT_DOUBLE_EQ(std::get<SimulationOptions>(recipe->recordings.at("room").source).offset_s, 0.007);
  EXPECT_EQ(recipe->estimates.at("room").options.ranges.size(), 2U);
  ASSERT_EQ(recipe->figures.size(), 4U);
  EXPECT_EQ(recipe->figures[0].formats.size(), 2U);
  EXPECT_EQ(recipe->figures[0].look.background, Background::kWhite);
  EXPECT_EQ(recipe->figures[1].look.colour_by, ColourBy::kBlur);
  EXPECT_EQ(recipe->figures[0].look.colour_by, ColourBy::kElevation) << "a figure's look is its own";
  EXPECT_TRUE(std::get<MapsFigure>(recipe->figures[1].what).maps.at(0).true_poses);
  EXPECT_FALSE(std::get<ProfileFigure>(recipe->figures[2].what).at_m.has_value());
  EXPECT_EQ(std::get<ScanFigure>(recipe->figures[3].what).at_s, 1.5);
  EXPECT_EQ(recipe->tables.at(0).columns.at(0).decimals, 1);
}

TEST_F(RecipeTest, ReadsAFigureOfTheOffsetOverTime) {
  const auto recipe = read(
      "recordings: {room: {simulate: room-1, offset_ms: 7}}\n"
      "estimates: {room: {recording: room, over-time: 20}}\n"
      "figures: {a: {kind: over-time, estimate: room}}\n");
  ASSERT_TRUE(recipe) << recipe.error().message;
  EXPECT_EQ(recipe->estimates.at("room").options.over_time_s, 20);
  EXPECT_EQ(std::get<OverTimeFigure>(recipe->figures.at(0).what).estimate, "room");
  EXPECT_EQ(refusal(kData + "figures: {a: {kind: over-time}}\n"), "3:14: figure a needs an estimate");
}

TEST_F(RecipeTest, ReadsAFigureOfTheResidualsOfARig) {
  const auto recipe = read(
      "recordings: {room: {simulate: room-1}}\n"
      "estimates: {room: {recording: room, solve: \"offset,mount\", prior: mount_deg=2}}\n"
      "figures: {a: {kind: residuals, estimate: room}}\n");
  ASSERT_TRUE(recipe) << recipe.error().message;
  EXPECT_TRUE(recipe->estimates.at("room").options.solve.mount);
  EXPECT_EQ(recipe->estimates.at("room").options.solve.mount_deg, 2);
  EXPECT_EQ(std::get<ResidualsFigure>(recipe->figures.at(0).what).estimate, "room");
  EXPECT_EQ(refusal(kData + "figures: {a: {kind: residuals}}\n"), "3:14: figure a needs an estimate");
}

TEST_F(RecipeTest, ReadsAPageThatIsInteractive) {
  const std::string maps = "maps: [{recording: room, offset_ms: 2}, {recording: room, offset_ms: 7}]";
  const auto recipe = read(kData + "figures: {a: {kind: interactive, " + maps + ", points: 5000}}\n");
  ASSERT_TRUE(recipe) << recipe.error().message;
  const auto& page = std::get<InteractiveFigure>(recipe->figures.at(0).what);
  EXPECT_EQ(page.points, 5000U);
  EXPECT_EQ(page.maps.size(), 2U);
  EXPECT_TRUE(recipe->figures[0].formats.empty());
  const auto refused = [&](const std::string& keys) {
    return refusal(kData + "figures: {a: {kind: interactive, " + keys + "}}\n");
  };
  EXPECT_NE(refused("maps: {recording: room, offset_ms: 7}").find("needs two maps of one recording"),
            std::string::npos);
  EXPECT_NE(refused(maps + ", formats: [png]").find("is a page: it has no formats"), std::string::npos);
  EXPECT_NE(refused(maps + ", points: 10").find("points"), std::string::npos);
}

TEST_F(RecipeTest, FilesAreRelativeToTheRecipe) {
  const auto recipe = read(
      "recordings: {walk: {file: bags/walk.bag, rig: rig.yaml, stamps: receive, window_s: [1, 2]}}\n"
      "figures: {d: {kind: scan, recording: walk, at_s: 0}}\n");
  ASSERT_TRUE(recipe) << recipe.error().message;
  const auto& file = std::get<RecordedFile>(recipe->recordings.at("walk").source);
  EXPECT_EQ(file.path, folder_ / "bags/walk.bag");
  EXPECT_EQ(*file.rig, folder_ / "rig.yaml");
  EXPECT_EQ(file.stamps, StampSource::kReceive);
}

TEST_F(RecipeTest, RefusalsSayLineColumnAndWhatIsWrong) {
  EXPECT_EQ(
      refusal(kData + "figure: {}\n"),
      "3:1: unknown key \"figure\" in the recipe; known are: estimates, figures, look, recordings, tables");
  const std::string kOneOf = "figure a: kind must be one of: curves, interactive, maps, ";
  EXPECT_TRUE(refusal(kData + "figures: {a: {kind: pie}}\n").starts_with("3:21: " + kOneOf));
  EXPECT_TRUE(refusal(kData + "figures: {a: {estimate: room}}\n").starts_with("3:14: " + kOneOf));
  EXPECT_EQ(refusal(kData + "figures: {a: {kind: curves, estimates: hall}}\n"),
            "3:40: there is no estimate \"hall\"; there are: room");
  EXPECT_EQ(refusal("recordings: {r: {simulate: moon}}\n").substr(0, 36),
            "1:28: there is no scene \"moon\"; ther");
  EXPECT_EQ(refusal(kData + "figures: {a: {kind: scan, recording: room, at_s: -1}}\n"),
            "3:50: figure a: at_s must be within 0 to 1e+06");
  EXPECT_EQ(refusal(kData + "figures: {../a: {kind: scan, recording: room}}\n"),
            "3:11: \"../a\" is not a name of letters, digits, dots, dashes and underscores");
  EXPECT_EQ(refusal(kData + "figures: {a: {kind: scan, recording: room, colour-by: smell}}\n").substr(0, 6),
            "3:55: ");
  EXPECT_EQ(refusal("a: [\n").substr(0, 2), "2:");
}

TEST_F(RecipeTest, WhatDoesNotGoTogetherIsRefused) {
  EXPECT_NE(refusal("recordings: {r: {simulate: room-1, file: a.bag}}\n").find("either simulate or file"),
            std::string::npos);
  EXPECT_NE(refusal("recordings: {r: {file: a.bag, noise_mm: 3}}\n").find("belong to a simulation"),
            std::string::npos);
  EXPECT_NE(refusal("recordings: {r: {simulate: room-1, stamps: header}}\n").find("belong to a file"),
            std::string::npos);
  EXPECT_NE(refusal("recordings: {r: {file: a.bag}}\n"
                    "figures: {a: {kind: maps, maps: {recording: r, offset_ms: 1, poses: truth}}}\n")
                .find("only a simulation knows"),
            std::string::npos);
  EXPECT_NE(
      refusal(kData + "figures: {a: {kind: profile, maps: {recording: room, offset_ms: 1}, at_m: [0, 1]}}\n")
          .find("needs heights_m"),
      std::string::npos);
  EXPECT_NE(refusal(kData + "figures: {a: {kind: maps}}\n").find("needs maps"), std::string::npos);
  EXPECT_NE(refusal(kData).find("neither figures nor tables"), std::string::npos);
  EXPECT_NE(refusal(kData + "tables: {t: {estimates: [room], columns: [{values: [a, b]}]}}\n")
                .find("2 values for 1 estimates"),
            std::string::npos);
}

TEST_F(RecipeTest, TheShippedOnesAreReadable) {
  for (const char* name : {"quick.yaml", "paper.yaml"}) {
    const auto recipe = read_recipe(std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "assets/figures" / name);
    EXPECT_TRUE(recipe) << recipe.error().message;
  }
}

}  // namespace
}  // namespace sweepscope
